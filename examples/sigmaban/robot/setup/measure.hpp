// How long answers and control cycles take on a line, against what the bytes say.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "../servos/feedback.hpp"
#include "bus_budget.hpp"
#include "servo_line.hpp"
#include "servo_settings.hpp"

namespace dynamixel {

struct LineMeasurement {
  BusBudget budget;           // with what was measured of single answers
  double cycle_s = 0;         // median of whole cycles [s]
  double share_lost = 0;      // of the answers in them
  std::uint32_t fastest = 0;  // speed that all servos can do [bit/s]
  std::size_t cycles = 0;
};

namespace measure_detail {

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Of questions to each servo in turn: what answers take beyond the time of the line and of the servo itself.
template <class ServoBus>
void measure_latency(ServoBus& bus, const std::vector<std::uint8_t>& ids, const Register& asked, int questions,
                     BusBudget& budget) {
  constexpr double least_timer_s = 3e-3;  // a program that waits for longer waits for the adapter's timer [s]
  std::vector<double> seconds;
  std::array<std::uint8_t, 64> packet{};
  std::array<std::uint8_t, 4> bytes{};
  for (int i = 0; i < questions; ++i) {
    const std::uint8_t id = ids[static_cast<std::size_t>(i) % ids.size()];
    const Time begin = bus.port().now();
    if (bus.read(id, asked.address, Buffer(bytes).first(asked.size))) {
      seconds.push_back(to_seconds(bus.port().now() - begin));
    }
  }
  if (seconds.empty()) throw BusError("no servo answers a question; is the line in order?");
  using Wire = typename ServoBus::Wire;
  const std::size_t sent = Wire::read_one(packet, {ids[0], asked.address, asked.size}).size();
  const double answer_s = median(std::move(seconds));
  const double line_s = to_seconds(line_time(sent + Wire::status_overhead + asked.size, budget.bits_per_s));
  budget.latency_s = std::max(0.0, answer_s - line_s - budget.return_delay_s);
  if (budget.latency_s > least_timer_s) budget.timer_s = answer_s;  // each waits for the next tick after the last one
}

}  // namespace measure_detail

namespace measure_detail {

/// What a cycle asks of servos that all have it in the same place.
struct Cycle {
  const Register* goal = nullptr;
  std::uint16_t address = 0, count = 0;  // of the feedback
  std::vector<std::uint8_t> goals;       // as they are
};

/// Throws BusError for servos under torque, and for those that have goal or position elsewhere than others.
template <class ServoBus>
Cycle survey(ServoBus& bus, const std::vector<std::uint8_t>& ids, LineMeasurement& result) {
  Cycle cycle;
  double delays = 0;
  std::size_t end = 0xFFFF;
  std::vector<const ServoModel*> models;
  for (const std::uint8_t id : ids) {
    const ServoModel* model = model_of(bus, id);
    if (model == nullptr) throw BusError("servo " + std::to_string(id) + " does not answer");
    ServoSettings<ServoBus> servo(bus, *model, id);
    if (servo.read(servo.at("torque_enable")) != 0) servo.fail("has its torque on; switch it off before measuring");
    const Feedback all(*model);
    const Register& goal = servo.at("goal_position");
    if (models.empty()) cycle = {&goal, all.address(), all.count(), {}};
    if (goal.address != cycle.goal->address || all.address() != cycle.address || all.count() != cycle.count) {
      servo.fail("has its goal or its position elsewhere than servo " + std::to_string(ids[0]) +
                 "; measure them apart (--ids)");
    }
    const std::uint32_t counts = servo.read(goal);
    for (unsigned i = 0; i < goal.size; ++i) cycle.goals.push_back(static_cast<std::uint8_t>(counts >> (8 * i)));
    delays += servo.read(servo.at("return_delay_time")) * return_delay_s;
    end = std::min(end, model->registers.back().end());
    models.push_back(model);
  }
  for (const std::uint32_t speed : baud2_rates) {
    const auto can = [&](const ServoModel* model) { return baud_rate_of(*model, speed).has_value(); };
    if (std::ranges::all_of(models, can)) result.fastest = speed;
  }
  bus.set_table_end(static_cast<std::uint16_t>(end));
  result.budget.return_delay_s = delays / static_cast<double>(ids.size());
  result.budget.goal_bytes = cycle.goal->size;
  result.budget.feedback_bytes = cycle.count;
  return cycle;
}

}  // namespace measure_detail

/// The servos must have their torque off: they are sent the goals that they have. Throws BusError where one has not.
template <class Protocol>
LineMeasurement measure_line(const ServoLine& line, const std::vector<std::uint8_t>& ids, int cycles) {
  using namespace measure_detail;
  LineMeasurement result;
  result.budget.protocol = line.protocol;
  result.budget.servos = ids.size();
  result.budget.bits_per_s = line.bits_per_s;
  auto bus = open_patiently<Protocol>(line.port, line.bits_per_s);
  const Cycle cycle = survey(bus, ids, result);
  measure_latency(bus, ids, *cycle.goal, cycles, result.budget);
  std::vector<double> seconds;
  std::vector<std::uint8_t> answers(ids.size() * cycle.count);
  std::vector<Outcome> outcomes(ids.size());
  std::size_t lost = 0;
  for (int i = 0; i < cycles; ++i) {
    const Time begin = bus.port().now();
    bus.sync_write(cycle.goal->address, ids, cycle.goals);
    const std::size_t answered = bus.sync_read(cycle.address, cycle.count, ids, answers, outcomes);
    seconds.push_back(to_seconds(bus.port().now() - begin));
    lost += ids.size() - answered;
  }
  result.cycles = static_cast<std::size_t>(cycles);
  result.cycle_s = median(std::move(seconds));
  result.share_lost = static_cast<double>(lost) / static_cast<double>(ids.size() * result.cycles);
  return result;
}

inline void print(const LineMeasurement& m, const std::string& port) {
  const BusBudget& b = m.budget;
  const double bytes_s = to_seconds(line_time(b.bytes(), b.bits_per_s));
  std::printf("%s: %zu servos, Protocol %d, %u bit/s; goals of %d bytes out, feedback of %d bytes back\n", port.c_str(),
              b.servos, b.protocol, b.bits_per_s, b.goal_bytes, b.feedback_bytes);
  std::printf("  latency of an answer            %8.3f ms  (%s)\n", 1e3 * b.latency_s,
              b.timer_s > 0 ? "the adapter hands bytes over by its latency timer" : "adapter and operating system");
  std::printf("  a cycle: bytes on the line      %8.3f ms  (%zu)\n", 1e3 * bytes_s, b.bytes());
  std::printf("           return delays          %8.3f ms\n", 1e3 * b.return_delay_s * static_cast<double>(b.servos));
  std::printf("  predicted                       %8.3f ms, %.0f Hz\n", 1e3 * b.cycle_s(), b.rate_hz());
  std::printf("  measured, median of %4zu         %8.3f ms, %.0f Hz; %.2f %% of the answers lost\n", m.cycles,
              1e3 * m.cycle_s, 1 / m.cycle_s, 100 * m.share_lost);
  for (const BudgetAdvice& a : advice(b, m.fastest)) std::printf("  %4.0f Hz with %s\n", a.rate_hz, a.what.c_str());
}

}  // namespace dynamixel
