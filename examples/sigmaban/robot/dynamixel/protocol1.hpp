// Dynamixel Protocol 1.0: FF FF id length code parameters checksum.
// ROBOTIS e-Manual, "DYNAMIXEL Protocol 1.0": length = parameters + 2; checksum = ~(id + length + code + parameters).
//
// Each function writes one packet into the caller's buffer and returns it: the front of the buffer, or nothing where it
// is too small, the packet would be longer than the protocol allows, or an argument is out of range.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "decoder.hpp"
#include "packet.hpp"

namespace dynamixel::protocol1 {

inline constexpr std::size_t max_packet_size = 4 + 255;  // [bytes]
inline constexpr std::uint8_t max_id = 0xFD;             // of a servo

/// Status Packet, Error.
enum ErrorBit : std::uint8_t {
  input_voltage_error = 1 << 0,
  angle_limit_error = 1 << 1,
  overheating_error = 1 << 2,
  range_error = 1 << 3,
  checksum_error = 1 << 4,
  overload_error = 1 << 5,
  instruction_error = 1 << 6
};

/// Of the bytes from id to the last parameter.
constexpr std::uint8_t checksum(Bytes bytes) {
  unsigned sum = 0;
  for (const std::uint8_t byte : bytes) sum += byte;
  return static_cast<std::uint8_t>(~sum);
}

/// Writes a packet parameter after parameter.
class PacketWriter {
 public:
  PacketWriter(Buffer out, std::uint8_t id, std::uint8_t code) : out_(out), valid_(id <= broadcast_id) {
    for (const std::uint8_t byte : {std::uint8_t{0xFF}, std::uint8_t{0xFF}, id, std::uint8_t{0}, code}) put(byte);
  }
  PacketWriter(Buffer out, std::uint8_t id, Instruction code)
      : PacketWriter(out, id, static_cast<std::uint8_t>(code)) {}

  void put(std::uint8_t byte) {
    if (size_ >= out_.size() || size_ >= max_packet_size) valid_ = false;
    if (valid_) out_[size_++] = byte;
  }
  void put(Bytes bytes) {
    for (const std::uint8_t byte : bytes) put(byte);
  }
  /// An address or a number of bytes, which this protocol has one byte for.
  void put_byte(std::uint16_t value) {
    if (value > 0xFF) valid_ = false;
    put(static_cast<std::uint8_t>(value));
  }
  /// An id of one servo.
  void put_id(std::uint8_t id) {
    if (id > max_id) valid_ = false;
    put(id);
  }
  void invalidate() { valid_ = false; }

  Bytes finish() {
    put(std::uint8_t{0});
    if (!valid_) return {};
    out_[3] = static_cast<std::uint8_t>(size_ - 4);
    out_[size_ - 1] = checksum(out_.subspan(2, size_ - 3));
    return out_.first(size_);
  }

 private:
  Buffer out_;
  std::size_t size_ = 0;
  bool valid_;
};

/// Any packet.
inline Bytes encode(Buffer out, std::uint8_t id, std::uint8_t code, Bytes parameters = {}) {
  PacketWriter packet(out, id, code);
  packet.put(parameters);
  return packet.finish();
}
inline Bytes encode(Buffer out, std::uint8_t id, Instruction code, Bytes parameters = {}) {
  return encode(out, id, static_cast<std::uint8_t>(code), parameters);
}

inline Bytes ping(Buffer out, std::uint8_t id) { return encode(out, id, Instruction::ping); }
inline Bytes action(Buffer out, std::uint8_t id = broadcast_id) { return encode(out, id, Instruction::action); }
inline Bytes factory_reset(Buffer out, std::uint8_t id) { return encode(out, id, Instruction::factory_reset); }
inline Bytes reboot(Buffer out, std::uint8_t id) { return encode(out, id, Instruction::reboot); }

/// `count` bytes from `address` on.
inline Bytes read(Buffer out, std::uint8_t id, std::uint16_t address, std::uint16_t count) {
  PacketWriter packet(out, id, Instruction::read);
  packet.put_byte(address);
  packet.put_byte(count);
  return packet.finish();
}

inline Bytes write(Buffer out, std::uint8_t id, std::uint16_t address, Bytes data,
                   Instruction code = Instruction::write) {
  PacketWriter packet(out, id, code);
  packet.put_byte(address);
  packet.put(data);
  return packet.finish();
}

/// A write that waits for an action.
inline Bytes reg_write(Buffer out, std::uint8_t id, std::uint16_t address, Bytes data) {
  return write(out, id, address, data, Instruction::reg_write);
}

/// `count` bytes to each id; `data` holds them one servo after the other.
inline Bytes sync_write(Buffer out, std::uint16_t address, std::uint16_t count, Bytes ids, Bytes data) {
  PacketWriter packet(out, broadcast_id, Instruction::sync_write);
  if (count == 0 || data.size() != ids.size() * count) packet.invalidate();
  packet.put_byte(address);
  packet.put_byte(count);
  for (std::size_t i = 0; i < ids.size() && data.size() >= (i + 1) * count; ++i) {
    packet.put_id(ids[i]);
    packet.put(data.subspan(i * count, count));
  }
  return packet.finish();
}

inline Bytes bulk_read(Buffer out, std::span<const BulkItem> items) {
  PacketWriter packet(out, broadcast_id, Instruction::bulk_read);
  packet.put(std::uint8_t{0});
  for (const BulkItem& item : items) {
    packet.put_byte(item.count);
    packet.put_id(item.id);
    packet.put_byte(item.address);
  }
  return packet.finish();
}

/// What a servo answers; `errors` of ErrorBit.
inline Bytes status(Buffer out, std::uint8_t id, std::uint8_t errors, Bytes data = {}) {
  return id <= max_id ? encode(out, id, errors, data) : Bytes{};
}

struct Status {
  std::uint8_t id = 0;
  std::uint8_t errors = 0;  // of ErrorBit
  Bytes data;
};

/// A packet that a servo sent. The protocol does not tell it from an instruction: who sent it must be known.
inline std::optional<Status> as_status(const Packet& packet) {
  if (packet.id > max_id) return std::nullopt;
  return Status{packet.id, packet.code, packet.parameters};
}

struct Framing {
  static Frame judge(Bytes bytes, std::size_t capacity) {
    constexpr Frame incomplete{}, garbage{Verdict::garbage};
    if (bytes[0] != 0xFF) return garbage;
    if (bytes.size() < 2) return incomplete;
    if (bytes[1] != 0xFF) return garbage;
    if (bytes.size() < 3) return incomplete;
    if (bytes[2] == 0xFF) return garbage;  // no id: the header begins one byte later
    if (bytes.size() < 4) return incomplete;
    const std::size_t size = std::size_t{4} + bytes[3];
    if (bytes[3] < 2 || size > capacity) return garbage;
    if (bytes.size() < size) return incomplete;
    if (checksum(bytes.subspan(2, size - 3)) != bytes[size - 1]) return {Verdict::bad_checksum};
    return {Verdict::packet, size};
  }

  static std::optional<Packet> open(Buffer bytes) {
    return Packet{bytes[2], bytes[4], bytes.subspan(5, bytes.size() - 6)};
  }
};

template <std::size_t Capacity = max_packet_size>
using Decoder = PacketDecoder<Framing, Capacity>;

}  // namespace dynamixel::protocol1
