// What both Dynamixel protocols share: packets, instructions and ids.
// ROBOTIS e-Manual, "DYNAMIXEL Protocol 1.0" and "DYNAMIXEL Protocol 2.0", sections Instruction Packet, Status Packet.
#pragma once

#include <cstdint>
#include <span>

namespace dynamixel {

using Bytes = std::span<const std::uint8_t>;
using Buffer = std::span<std::uint8_t>;

/// Every servo carries the instruction out and none answers (but ping and the reads of many, in Protocol 2.0).
inline constexpr std::uint8_t broadcast_id = 0xFE;

/// sync_read, fast_sync_read, bulk_write, clear and status belong to Protocol 2.0 alone.
enum class Instruction : std::uint8_t {
  ping = 0x01,
  read = 0x02,
  write = 0x03,
  reg_write = 0x04,
  action = 0x05,
  factory_reset = 0x06,
  reboot = 0x08,
  clear = 0x10,
  status = 0x55,
  sync_read = 0x82,
  sync_write = 0x83,
  fast_sync_read = 0x8A,
  bulk_read = 0x92,
  bulk_write = 0x93
};

/// As decoded, stuffing removed. The parameters lie in the decoder: valid until its next call.
struct Packet {
  std::uint8_t id = 0;
  std::uint8_t code = 0;  // the instruction; in a status packet of Protocol 1.0, the error bits
  Bytes parameters;
};

/// What to read from one servo, for a bulk read.
struct BulkItem {
  std::uint8_t id = 0;
  std::uint16_t address = 0;
  std::uint16_t count = 0;  // of bytes
};

}  // namespace dynamixel
