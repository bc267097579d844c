// Answers under way to the host, each with the moment it is due.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "../bus/transport.hpp"

namespace dynamixel {

struct OutgoingPacket {
  Time due{};
  std::size_t size = 0;
  std::array<std::uint8_t, 256> bytes{};
};

/// Up to 256 without allocating.
class OutgoingQueue {
 public:
  OutgoingQueue() { packets_.reserve(256); }

  void add(const OutgoingPacket& packet) { packets_.push_back(packet); }

  std::optional<Time> next_due() const {
    if (packets_.empty()) return std::nullopt;
    return packets_[next()].due;
  }

  /// The next one that is due by `now`, if `out` has room for it; its size, or 0.
  std::size_t take(Time now, Buffer out) {
    if (packets_.empty()) return 0;
    const std::size_t first = next();
    const OutgoingPacket& packet = packets_[first];
    if (packet.due > now || packet.size > out.size()) return 0;
    const std::size_t size = packet.size;
    std::copy_n(packet.bytes.begin(), size, out.begin());
    packets_.erase(packets_.begin() + static_cast<std::ptrdiff_t>(first));
    return size;
  }

 private:
  /// The first of those due first.
  std::size_t next() const {
    const auto first = std::min_element(packets_.begin(), packets_.end(),
                                        [](const OutgoingPacket& a, const OutgoingPacket& b) { return a.due < b.due; });
    return static_cast<std::size_t>(first - packets_.begin());
  }

  std::vector<OutgoingPacket> packets_;
};

}  // namespace dynamixel
