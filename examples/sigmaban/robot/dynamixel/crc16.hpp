// The check sum of Dynamixel Protocol 2.0: CRC-16 with polynomial x^16 + x^15 + x^2 + 1 (0x8005), initial value 0, bits
// not reflected, no final inversion (ROBOTIS e-Manual, "DYNAMIXEL Protocol 2.0", CRC; also called CRC-16/BUYPASS).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dynamixel {

namespace crc_detail {

consteval std::array<std::uint16_t, 256> make_table() {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t byte = 0; byte < table.size(); ++byte) {
    unsigned rest = static_cast<unsigned>(byte) << 8;
    for (int bit = 0; bit < 8; ++bit) rest = (rest & 0x8000U) != 0 ? (rest << 1) ^ 0x8005U : rest << 1;
    table[byte] = static_cast<std::uint16_t>(rest);
  }
  return table;
}

inline constexpr std::array<std::uint16_t, 256> table = make_table();

}  // namespace crc_detail

/// Of `bytes`, after those that gave `crc`.
constexpr std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t crc = 0) {
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>((crc << 8) ^ crc_detail::table[(crc >> 8) ^ byte]);
  }
  return crc;
}

}  // namespace dynamixel
