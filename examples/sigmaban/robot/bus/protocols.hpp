// Both protocols in one shape, for code that works with either.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "../dynamixel/protocol1.hpp"
#include "../dynamixel/protocol2.hpp"

namespace dynamixel {

/// An answer. In Protocol 1.0 error bits are about the servo's health or the instruction; in 2.0 the lower seven are a
/// number and the highest one an alert.
struct Status {
  std::uint8_t id = 0;
  std::uint8_t error_bits = 0;
  bool refused = false;  // the servo did not do what it was told
  Bytes data;
};

inline bool reads_the_same(std::span<const BulkItem> items) {
  return std::all_of(items.begin(), items.end(), [&](const BulkItem& item) {
    return item.address == items.front().address && item.count == items.front().count;
  });
}

struct Protocol1 {
  static constexpr int version = 1;
  static constexpr std::uint8_t max_id = protocol1::max_id;
  static constexpr std::size_t number_size = 1;      // of an address or a count [bytes]
  static constexpr std::size_t status_overhead = 6;  // bytes of a status packet that carry no data
  static constexpr std::size_t ping_answer = 0;      // bytes of data
  static constexpr std::uint16_t table_end = 74;     // address behind the last one of MX servos
  template <std::size_t Capacity>
  using Decoder = protocol1::Decoder<Capacity>;

  static Bytes ping(Buffer out, std::uint8_t id) { return protocol1::ping(out, id); }
  static Bytes action(Buffer out) { return protocol1::action(out); }
  static Bytes reboot(Buffer out, std::uint8_t id) { return protocol1::reboot(out, id); }
  static Bytes write(Buffer out, std::uint8_t id, std::uint16_t address, Bytes data, Instruction code) {
    return protocol1::write(out, id, address, data, code);
  }
  static Bytes sync_write(Buffer out, std::uint16_t address, std::uint16_t count, Bytes ids, Bytes data) {
    return protocol1::sync_write(out, address, count, ids, data);
  }
  static Bytes read_one(Buffer out, const BulkItem& item) {
    return protocol1::read(out, item.id, item.address, item.count);
  }
  /// There is no sync read.
  static Bytes read_many(Buffer out, std::span<const BulkItem> items) { return protocol1::bulk_read(out, items); }

  static std::optional<Status> as_status(const Packet& packet) {
    const auto status = protocol1::as_status(packet);
    if (!status) return std::nullopt;
    constexpr unsigned not_done = protocol1::range_error | protocol1::checksum_error | protocol1::instruction_error;
    return Status{status->id, status->errors, (status->errors & not_done) != 0, status->data};
  }
  static Bytes status(Buffer out, const Status& status) {
    return protocol1::status(out, status.id, status.error_bits, status.data);
  }
};

struct Protocol2 {
  static constexpr int version = 2;
  static constexpr std::uint8_t max_id = protocol2::max_id;
  static constexpr std::size_t number_size = 2;
  static constexpr std::size_t status_overhead = 11;
  static constexpr std::size_t ping_answer = 3;
  static constexpr std::uint16_t table_end = 662;
  template <std::size_t Capacity>
  using Decoder = protocol2::Decoder<Capacity>;

  static Bytes ping(Buffer out, std::uint8_t id) { return protocol2::ping(out, id); }
  static Bytes action(Buffer out) { return protocol2::action(out); }
  static Bytes reboot(Buffer out, std::uint8_t id) { return protocol2::reboot(out, id); }
  static Bytes bulk_write(Buffer out, std::span<const BulkItem> items, Bytes data) {
    return protocol2::bulk_write(out, items, data);
  }
  static Bytes write(Buffer out, std::uint8_t id, std::uint16_t address, Bytes data, Instruction code) {
    return protocol2::write(out, id, address, data, code);
  }
  static Bytes sync_write(Buffer out, std::uint16_t address, std::uint16_t count, Bytes ids, Bytes data) {
    return protocol2::sync_write(out, address, count, ids, data);
  }
  static Bytes read_one(Buffer out, const BulkItem& item) {
    return protocol2::read(out, item.id, item.address, item.count);
  }
  static constexpr std::size_t block_overhead = 4;  // bytes of a block of a fast sync read that carry no data
  /// A sync read where all are asked for the same bytes.
  static Bytes read_many(Buffer out, std::span<const BulkItem> items, bool fast = false) {
    if (!reads_the_same(items)) return protocol2::bulk_read(out, items);
    protocol2::PacketWriter packet(out, broadcast_id, fast ? Instruction::fast_sync_read : Instruction::sync_read);
    packet.put_word(items.front().address);
    packet.put_word(items.front().count);
    for (const BulkItem& item : items) packet.put_id(item.id);
    return packet.finish();
  }

  static std::optional<Status> as_status(const Packet& packet) {
    const auto status = protocol2::as_status(packet);
    if (!status) return std::nullopt;
    const unsigned number = static_cast<unsigned>(status->error);
    return Status{status->id, static_cast<std::uint8_t>(number | (status->alert ? protocol2::alert_bit : 0U)),
                  number != 0, status->data};
  }
  static Bytes status(Buffer out, const Status& status) {
    return protocol2::status(out, status.id, static_cast<protocol2::Error>(status.error_bits & 0x7F),
                             (status.error_bits & protocol2::alert_bit) != 0, status.data);
  }
};

}  // namespace dynamixel
