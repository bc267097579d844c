// Finds packets in a stream of bytes, whatever else is in it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "packet.hpp"

namespace dynamixel {

/// What the bytes at hand begin with.
enum class Verdict { incomplete, garbage, bad_checksum, packet };

struct Frame {
  Verdict verdict = Verdict::incomplete;
  std::size_t size = 0;  // of a packet, with header and check sum
};

/// Takes bytes as they come. Bytes that begin no packet are dropped up to the next one that may, so a packet is found
/// after, before and between garbage, also where a damaged packet ran into it. Nothing is allocated; a byte costs
/// constant time, but where a packet turns out damaged (proportional to its size, times the headers in it).
///
/// `Framing` (Protocol1Framing, Protocol2Framing) judges bytes. Packets above `Capacity` bytes count as garbage.
template <class Framing, std::size_t Capacity>
class PacketDecoder {
 public:
  struct Statistics {
    std::uint64_t packets = 0;
    std::uint64_t dropped_bytes = 0;
    std::uint64_t bad_checksums = 0;  // of what looked like packets
  };

  /// Adds a byte. Ask next() until it has none before the next push: a decoder that is full drops its oldest byte.
  void push(std::uint8_t byte) {
    remove_taken();
    if (size_ == Capacity) drop_first();
    bytes_[size_++] = byte;
  }

  /// The next complete packet; it stays valid until the next call of this decoder.
  std::optional<Packet> next() {
    remove_taken();
    while (size_ > 0) {
      const Frame frame = Framing::judge(Bytes(bytes_.data(), size_), longest_);
      if (frame.verdict == Verdict::incomplete) return std::nullopt;
      if (frame.verdict == Verdict::packet) {
        if (const auto packet = Framing::open(Buffer(bytes_.data(), frame.size))) {
          taken_ = frame.size;
          ++statistics_.packets;
          return packet;
        }
      } else if (frame.verdict == Verdict::bad_checksum) {
        ++statistics_.bad_checksums;
      }
      drop_first();
    }
    return std::nullopt;
  }

  /// From now on longer packets count as garbage; at most Capacity.
  void set_longest(std::size_t bytes) { longest_ = std::min(bytes, Capacity); }

  /// Pushes all of `bytes` and calls sink(packet) for every packet they complete.
  template <class Sink>
  void decode(Bytes bytes, Sink sink) {
    for (const std::uint8_t byte : bytes) {
      push(byte);
      while (const auto packet = next()) sink(*packet);
    }
  }

  /// To call when a deadline has passed: the packet begun is not waited for. Whole packets among its bytes are then
  /// what next() gives; to be called again until pending() is 0.
  void give_up() {
    remove_taken();
    if (size_ > 0) drop_first();
  }

  /// Bytes of packets begun [count].
  std::size_t pending() const { return size_ - taken_; }

  const Statistics& statistics() const { return statistics_; }

 private:
  void remove_front(std::size_t count) {
    std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(count), bytes_.begin() + static_cast<std::ptrdiff_t>(size_),
              bytes_.begin());
    size_ -= count;
  }

  void remove_taken() {
    if (taken_ == 0) return;
    remove_front(taken_);
    taken_ = 0;
  }

  /// The first byte begins no packet: on to the next that may.
  void drop_first() {
    std::size_t count = 1;
    while (count < size_ && bytes_[count] != 0xFF) ++count;  // both headers begin so
    statistics_.dropped_bytes += count;
    remove_front(count);
  }

  std::array<std::uint8_t, Capacity> bytes_{};
  std::size_t size_ = 0;
  std::size_t longest_ = Capacity;
  std::size_t taken_ = 0;  // bytes of the packet handed out last, at the front
  Statistics statistics_;
};

}  // namespace dynamixel
