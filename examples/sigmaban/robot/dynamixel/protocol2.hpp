// Dynamixel Protocol 2.0: FF FF FD 00 id length(2) instruction parameters crc(2), all numbers low byte first.
// ROBOTIS e-Manual, "DYNAMIXEL Protocol 2.0": length = parameters + 3, with stuffing; a FD follows every FF FF FD from
// the instruction to the last parameter; the CRC is over all bytes before it, with stuffing.
//
// Each function writes one packet into the caller's buffer and returns it: the front of the buffer, or nothing where it
// is too small, the packet would be longer than the protocol allows, or an argument is out of range.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "crc16.hpp"
#include "decoder.hpp"
#include "packet.hpp"

namespace dynamixel::protocol2 {

inline constexpr std::size_t max_packet_size = 7 + 0xFFFF;  // [bytes]
inline constexpr std::uint8_t max_id = 0xFC;                // of a servo

/// Status Packet, Error: what went wrong with the instruction.
enum class Error : std::uint8_t {
  none = 0,
  result_fail = 1,
  instruction = 2,
  crc = 3,
  data_range = 4,
  data_length = 5,
  data_limit = 6,
  access = 7
};

inline constexpr std::uint8_t alert_bit = 0x80;  // something is wrong with the servo: see its Hardware Error Status

/// Hardware Error Status(70) and Shutdown(63) of the MX series.
enum HardwareErrorBit : std::uint8_t {
  input_voltage_error = 1 << 0,
  overheating_error = 1 << 2,
  motor_encoder_error = 1 << 3,
  electrical_shock_error = 1 << 4,
  overload_error = 1 << 5
};

/// What a factory reset leaves alone.
enum class ResetOption : std::uint8_t { all = 0xFF, all_but_id = 0x01, all_but_id_and_baud_rate = 0x02 };

/// Follows what was written or read since the instruction: true when FF FF FD is complete and a FD must follow.
class StuffingWatch {
 public:
  constexpr bool after(std::uint8_t byte) {
    const bool complete = ones_ >= 2 && byte == 0xFD;
    ones_ = byte == 0xFF ? ones_ + 1 : 0;
    return complete;
  }

 private:
  std::size_t ones_ = 0;  // bytes FF in a row
};

/// Writes a packet parameter after parameter.
class PacketWriter {
 public:
  PacketWriter(Buffer out, std::uint8_t id, Instruction code) : out_(out), valid_(id <= max_id || id == broadcast_id) {
    for (const int byte : {0xFF, 0xFF, 0xFD, 0x00, int{id}, 0, 0}) raw(byte);
    put(static_cast<std::uint8_t>(code));
  }

  void put(std::uint8_t byte) {
    raw(byte);
    if (watch_.after(byte)) raw(0xFD);
  }
  void put(Bytes bytes) {
    for (const std::uint8_t byte : bytes) put(byte);
  }
  void put_word(std::uint16_t value) {
    put(static_cast<std::uint8_t>(value & 0xFF));
    put(static_cast<std::uint8_t>(value >> 8));
  }
  /// An id of one servo.
  void put_id(std::uint8_t id) {
    if (id > max_id) valid_ = false;
    put(id);
  }
  void invalidate() { valid_ = false; }

  Bytes finish() {
    raw(0);
    raw(0);
    if (!valid_) return {};
    set_word(5, size_ - 7);
    set_word(size_ - 2, crc16(out_.first(size_ - 2)));
    return out_.first(size_);
  }

 private:
  void raw(int byte) {
    if (size_ >= out_.size() || size_ >= max_packet_size) valid_ = false;
    if (valid_) out_[size_++] = static_cast<std::uint8_t>(byte);
  }
  void set_word(std::size_t at, std::size_t value) {
    out_[at] = static_cast<std::uint8_t>(value & 0xFF);
    out_[at + 1] = static_cast<std::uint8_t>(value >> 8);
  }

  Buffer out_;
  std::size_t size_ = 0;
  bool valid_;
  StuffingWatch watch_;
};

/// Any packet.
inline Bytes encode(Buffer out, std::uint8_t id, Instruction code, Bytes parameters = {}) {
  PacketWriter packet(out, id, code);
  packet.put(parameters);
  return packet.finish();
}

inline Bytes ping(Buffer out, std::uint8_t id) { return encode(out, id, Instruction::ping); }
inline Bytes action(Buffer out, std::uint8_t id = broadcast_id) { return encode(out, id, Instruction::action); }
inline Bytes reboot(Buffer out, std::uint8_t id) { return encode(out, id, Instruction::reboot); }

/// Servos of firmware 42 and later refuse to reset all of everyone.
inline Bytes factory_reset(Buffer out, std::uint8_t id, ResetOption option) {
  const std::uint8_t parameter = static_cast<std::uint8_t>(option);
  return encode(out, id, Instruction::factory_reset, Bytes(&parameter, 1));
}

/// Forgets the turns of a servo at rest: its position becomes that within one turn.
inline Bytes clear_turns(Buffer out, std::uint8_t id) {
  constexpr std::uint8_t parameters[] = {0x01, 0x44, 0x58, 0x4C, 0x22};
  return encode(out, id, Instruction::clear, parameters);
}

/// `count` bytes from `address` on.
inline Bytes read(Buffer out, std::uint8_t id, std::uint16_t address, std::uint16_t count) {
  PacketWriter packet(out, id, Instruction::read);
  packet.put_word(address);
  packet.put_word(count);
  return packet.finish();
}

inline Bytes write(Buffer out, std::uint8_t id, std::uint16_t address, Bytes data,
                   Instruction code = Instruction::write) {
  PacketWriter packet(out, id, code);
  packet.put_word(address);
  packet.put(data);
  return packet.finish();
}

/// A write that waits for an action.
inline Bytes reg_write(Buffer out, std::uint8_t id, std::uint16_t address, Bytes data) {
  return write(out, id, address, data, Instruction::reg_write);
}

/// The same `count` bytes of each id; the servos answer in this order. A fast one is answered by one packet of all, to
/// which each servo adds a block: error, id, data, and the CRC of all bytes before it; nothing in it is stuffed.
inline Bytes sync_read(Buffer out, std::uint16_t address, std::uint16_t count, Bytes ids,
                       Instruction code = Instruction::sync_read) {
  PacketWriter packet(out, broadcast_id, code);
  packet.put_word(address);
  packet.put_word(count);
  for (const std::uint8_t id : ids) packet.put_id(id);
  return packet.finish();
}

/// `count` bytes to each id; `data` holds them one servo after the other.
inline Bytes sync_write(Buffer out, std::uint16_t address, std::uint16_t count, Bytes ids, Bytes data) {
  PacketWriter packet(out, broadcast_id, Instruction::sync_write);
  if (count == 0 || data.size() != ids.size() * count) packet.invalidate();
  packet.put_word(address);
  packet.put_word(count);
  for (std::size_t i = 0; i < ids.size() && data.size() >= (i + 1) * count; ++i) {
    packet.put_id(ids[i]);
    packet.put(data.subspan(i * count, count));
  }
  return packet.finish();
}

inline Bytes bulk_read(Buffer out, std::span<const BulkItem> items) {
  PacketWriter packet(out, broadcast_id, Instruction::bulk_read);
  for (const BulkItem& item : items) {
    packet.put_id(item.id);
    packet.put_word(item.address);
    packet.put_word(item.count);
  }
  return packet.finish();
}

/// Writes item.count bytes to each; `data` holds them one servo after the other.
inline Bytes bulk_write(Buffer out, std::span<const BulkItem> items, Bytes data) {
  PacketWriter packet(out, broadcast_id, Instruction::bulk_write);
  for (const BulkItem& item : items) {
    packet.put_id(item.id);
    packet.put_word(item.address);
    packet.put_word(item.count);
    if (item.count > data.size()) return {};
    packet.put(data.first(item.count));
    data = data.subspan(item.count);
  }
  if (!data.empty()) packet.invalidate();
  return packet.finish();
}

/// What a servo answers.
inline Bytes status(Buffer out, std::uint8_t id, Error error, bool alert = false, Bytes data = {}) {
  PacketWriter packet(out, id, Instruction::status);
  if (id > max_id) packet.invalidate();
  packet.put(static_cast<std::uint8_t>(static_cast<unsigned>(error) | (alert ? alert_bit : 0U)));
  packet.put(data);
  return packet.finish();
}

struct Status {
  std::uint8_t id = 0;
  Error error = Error::none;
  bool alert = false;
  Bytes data;
};

/// None if a packet is an instruction, or has no room for an error. An error may be one that has no name here.
inline std::optional<Status> as_status(const Packet& packet) {
  if (packet.code != static_cast<std::uint8_t>(Instruction::status) || packet.id > max_id) return std::nullopt;
  if (packet.parameters.empty()) return std::nullopt;
  const std::uint8_t error = packet.parameters[0];
  return Status{packet.id, static_cast<Error>(error & 0x7F), (error & alert_bit) != 0, packet.parameters.subspan(1)};
}

struct Framing {
  static Frame judge(Bytes bytes, std::size_t capacity) {
    constexpr Frame incomplete{}, garbage{Verdict::garbage};
    constexpr std::uint8_t header[] = {0xFF, 0xFF, 0xFD, 0x00};
    for (std::size_t i = 0; i < 4; ++i) {
      if (bytes.size() <= i) return incomplete;
      if (bytes[i] != header[i]) return garbage;  // a stuffed FF FF FD FD too
    }
    if (bytes.size() < 5) return incomplete;
    if (bytes[4] > max_id && bytes[4] != broadcast_id) return garbage;
    if (bytes.size() < 7) return incomplete;
    const std::size_t length = bytes[5] + std::size_t{256} * bytes[6], size = length + 7;
    if (length < 3 || size > capacity) return garbage;
    if (bytes.size() < size) return incomplete;
    const std::size_t crc = bytes[size - 2] + std::size_t{256} * bytes[size - 1];
    if (crc16(bytes.first(size - 2)) != crc) return {Verdict::bad_checksum};
    return {Verdict::packet, size};
  }

  /// Takes the stuffing out, in place. None where it is missing, bytes unchanged: no sender makes such a packet.
  static std::optional<Packet> open(Buffer bytes) {
    const Buffer body = bytes.subspan(7, bytes.size() - 9);
    StuffingWatch watch;
    for (std::size_t i = 0; i < body.size(); ++i) {
      if (!watch.after(body[i])) continue;
      ++i;
      if (i == body.size() || body[i] != 0xFD) return std::nullopt;
    }
    watch = {};
    std::size_t kept = 0;
    for (std::size_t i = 0; i < body.size(); ++i) {
      const std::uint8_t byte = body[i];
      body[kept++] = byte;
      if (watch.after(byte)) ++i;
    }
    return Packet{bytes[4], body[0], body.subspan(1, kept - 1)};
  }
};

/// 1 kB holds a sync write of 4 bytes to 200 servos; where damaged lengths must not be waited for, take what is needed.
template <std::size_t Capacity = 1024>
using Decoder = PacketDecoder<Framing, Capacity>;

}  // namespace dynamixel::protocol2
