// The answer of many servos to a fast sync read: one packet, to which each adds its block.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../bus/protocols.hpp"
#include "../dynamixel/crc16.hpp"
#include "outgoing_queue.hpp"

namespace dynamixel {

/// Allocates nothing after construction, up to 4 kB.
class FastAnswer {
 public:
  FastAnswer() { bytes_.reserve(4096); }

  /// `servos` will add `count` bytes each.
  void begin(std::size_t servos, std::size_t count) {
    const std::size_t length = 1 + servos * (count + Protocol2::block_overhead);
    bytes_ = {0xFF,         0xFF,        0xFD,         0x00,
              broadcast_id, low(length), high(length), static_cast<std::uint8_t>(Instruction::status)};
    sent_ = 0;
  }

  bool begun() const { return sent_ > 0; }

  /// What the servo sends: its block, the first one with the head of the packet before it.
  OutgoingPacket add(std::uint8_t id, std::uint8_t error_bits, Bytes data) {
    bytes_.push_back(error_bits);
    bytes_.push_back(id);
    bytes_.insert(bytes_.end(), data.begin(), data.end());
    const std::size_t crc = crc16(bytes_);
    bytes_.push_back(low(crc));
    bytes_.push_back(high(crc));
    OutgoingPacket packet;
    packet.size = bytes_.size() - sent_;
    std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(sent_), bytes_.end(), packet.bytes.begin());
    sent_ = bytes_.size();
    return packet;
  }

 private:
  static std::uint8_t low(std::size_t number) { return static_cast<std::uint8_t>(number & 0xFF); }
  static std::uint8_t high(std::size_t number) { return static_cast<std::uint8_t>(number >> 8); }

  std::vector<std::uint8_t> bytes_;
  std::size_t sent_ = 0;
};

}  // namespace dynamixel
