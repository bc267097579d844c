// What a control cycle takes on a bus, by its bytes, delays and latency, and what would make it shorter.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "../bus/protocols.hpp"
#include "../bus/transport.hpp"

namespace dynamixel {

/// A cycle: goals to all servos, then a question to all.
struct BusBudget {
  int protocol = 2;
  std::size_t servos = 12;
  std::uint32_t bits_per_s = 1'000'000;
  double return_delay_s = 500e-6;  // of each servo [s]
  double latency_s = 0;            // from the last byte on the line until the program has the answer, once a cycle [s]
  double timer_s = 0;              // period at which the adapter hands bytes over, instead; 0: as they come [s]
  std::uint16_t goal_bytes = 4;    // to each servo
  std::uint16_t feedback_bytes = 4;  // from each servo

  /// Of what is sent and received in a cycle.
  std::size_t bytes() const { return protocol == 1 ? bytes_of<Protocol1>() : bytes_of<Protocol2>(); }
  double cycle_s() const {
    const double busy = static_cast<double>(servos) * return_delay_s +
                        10 * (static_cast<double>(bytes()) + marks * static_cast<double>(servos)) / bits_per_s;
    return timer_s > 0 ? timer_s * std::ceil(busy / timer_s) : busy + latency_s;
  }
  double rate_hz() const { return 1 / cycle_s(); }

 private:
  static constexpr double marks = 0.5;  // bytes by which a bus marks its questions, 0 and 1 in turn

  template <class Protocol>
  std::size_t bytes_of() const {
    std::array<std::uint8_t, 1024> packet{};
    std::array<std::uint8_t, 512> goals{};
    std::array<std::uint8_t, 64> ids{};
    std::array<BulkItem, 64> items{};
    for (std::size_t i = 0; i < servos; ++i) {
      ids[i] = static_cast<std::uint8_t>(i + 1);
      items[i] = {ids[i], 100, feedback_bytes};
    }
    const Bytes data = Bytes(goals).first(servos * goal_bytes);
    return Protocol::sync_write(packet, 100, goal_bytes, Bytes(ids).first(servos), data).size() +
           Protocol::read_many(packet, std::span<const BulkItem>(items).first(servos)).size() +
           servos * (Protocol::status_overhead + feedback_bytes);
  }
};

struct BudgetAdvice {
  std::string what;
  double rate_hz = 0;
};

/// What one could change, and the rate then; what gains less than 5 % is left out. `fastest`: speed that all servos can
/// do [bit/s].
inline std::vector<BudgetAdvice> advice(const BusBudget& now, std::uint32_t fastest) {
  std::vector<BudgetAdvice> result;
  const auto add = [&](const std::string& what, const BusBudget& then) {
    if (then.rate_hz() > 1.05 * now.rate_hz()) result.push_back({what, then.rate_hz()});
  };
  BusBudget all = now;
  const auto one = [&](const std::string& what, auto change) {
    BusBudget then = now;
    change(then);
    change(all);
    add(what, then);
  };
  one("Return Delay Time 0 in all servos (setup --return-delay 0)", [](BusBudget& b) { b.return_delay_s = 0; });
  one("the fastest speed that all servos can do, " + std::to_string(fastest) + " bit/s (setup --new-baud)",
      [&](BusBudget& b) { b.bits_per_s = std::max(b.bits_per_s, fastest); });
  one("a latency timer of 1 ms (setserial PORT low_latency)", [](BusBudget& b) {
    b.latency_s = std::min(b.latency_s, 1e-3);
    b.timer_s = 0;
  });
  if (result.size() > 1) add("all of that", all);
  if (now.servos > 1) {
    BusBudget half = now;
    half.servos = (now.servos + 1) / 2;
    add("half of the servos on a second port", half);
  }
  return result;
}

}  // namespace dynamixel
