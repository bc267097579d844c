// Twenty or so servos on a line without a port, and the bus that asks them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "examples/sigmaban/robot/bus/bus.hpp"
#include "examples/sigmaban/robot/virtual_bus/memory_transport.hpp"

namespace dynamixel {

template <class Protocol>
constexpr const ServoModel& mx_64() {
  return Protocol::version == 1 ? mx_64_protocol_1 : mx_64_protocol_2;
}

/// Bytes of motion and health of an MX-64.
template <class Protocol>
struct StateBytes {
  static constexpr std::uint16_t address = Protocol::version == 1 ? 36 : 128;
  static constexpr std::uint16_t count = Protocol::version == 1 ? 8 : 19;
};

template <class Protocol>
struct TestLine {
  static std::vector<VirtualServo> servos(int count) {
    std::vector<VirtualServo> made;
    for (int i = 1; i <= count; ++i) made.emplace_back(mx_64<Protocol>(), static_cast<std::uint8_t>(i), 0.05 * i);
    return made;
  }

  explicit TestLine(int count, AnswererOptions options = {}, BusOptions bus_options = quick(), std::size_t chunk = 1024,
                    bool echo = false)
      : answerer(servos(count), options), bus(MemoryTransport<Protocol>(answerer, chunk, echo), bus_options) {
    for (int i = 1; i <= count; ++i) ids.push_back(static_cast<std::uint8_t>(i));
    data.resize(ids.size() * StateBytes<Protocol>::count);
    outcomes.resize(ids.size());
  }

  static BusOptions quick() { return {.return_delay_s = 0, .latency_s = 200e-6}; }

  /// Reads the state of all; counts answers that are not what the servo sent.
  std::size_t read_all(Time deadline = Time::max()) {
    constexpr std::size_t count = StateBytes<Protocol>::count;
    const std::uint64_t first = answerer.instructions() + 1;
    const std::size_t answered = bus.sync_read(StateBytes<Protocol>::address, count, ids, data, outcomes, deadline);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (outcomes[i] != Outcome::answered) continue;
      wrong += answerer.gave(ids[i], Bytes(data).subspan(i * count, count), first) ? 0U : 1U;
    }
    return answered;
  }

  /// Cycles of 10 ms in which all servos get goals and are read within 8 ms. Returns how many answers there were.
  std::size_t cycle(int cycles) {
    std::size_t answered = 0;
    std::vector<std::uint8_t> goals;
    for (int i = 0; i < cycles; ++i) {
      const Time start = bus.port().now();
      goals.clear();
      for (std::size_t j = 0; j < ids.size(); ++j) {
        const unsigned goal = 2048U + static_cast<unsigned>((13 * i + 29 * static_cast<int>(j)) % 400);
        goals.push_back(static_cast<std::uint8_t>(goal & 0xFF));
        goals.push_back(static_cast<std::uint8_t>(goal >> 8));
        if (Protocol::version == 2) goals.insert(goals.end(), 2, 0);
      }
      bus.sync_write(mx_64<Protocol>().find("goal_position")->address, ids, goals);
      answered += read_all(start + from_seconds(0.008));
      const Time spent = bus.port().now() - start;
      longest = std::max(longest, spent);
      if (spent < from_seconds(0.010)) bus.port().wait(from_seconds(0.010) - spent);
    }
    return answered;
  }

  /// Of all servos, once nothing is under way any more.
  ServoStatistics total() {
    bus.port().wait(from_seconds(1));
    bus.listen();
    ServoStatistics sum;
    for (const std::uint8_t id : ids) sum += bus.statistics(id);
    return sum;
  }

  Answerer<Protocol> answerer;
  Bus<Protocol, MemoryTransport<Protocol>> bus;
  std::vector<std::uint8_t> ids, data;
  std::vector<Outcome> outcomes;
  std::size_t wrong = 0;  // answers accepted that no servo gave in time
  Time longest{};
};

/// Each time a servo was asked ended in one way.
inline bool adds_up(const ServoStatistics& s) {
  return s.asked == s.answered + s.lost + s.corrupted + s.late + s.skipped + s.wrong_id + s.wrong_length + s.refused;
}

}  // namespace dynamixel
