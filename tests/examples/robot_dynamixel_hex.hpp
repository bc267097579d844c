// Packets written as in a manual: "FF FF 01 02 01 FB".
#pragma once

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "examples/sigmaban/robot/dynamixel/packet.hpp"

namespace dynamixel {

inline std::vector<std::uint8_t> bytes_of(const std::string& hex) {
  std::istringstream text(hex);
  std::vector<std::uint8_t> bytes;
  for (unsigned byte = 0; text >> std::hex >> byte;) bytes.push_back(static_cast<std::uint8_t>(byte));
  return bytes;
}

inline std::string hex_of(Bytes bytes) {
  constexpr const char* digits = "0123456789ABCDEF";
  std::string hex;
  for (const std::uint8_t byte : bytes) {
    if (!hex.empty()) hex += ' ';
    hex += digits[byte >> 4];
    hex += digits[byte & 15];
  }
  return hex;
}

}  // namespace dynamixel
