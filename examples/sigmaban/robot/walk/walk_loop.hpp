// The control loop of the robot: ball, policy, gait, walk engine, servos, at a fixed rate of the monotonic clock.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "../bus/transport.hpp"
#include "../servos/servo_group.hpp"
#include "../walk_engine/walk_engine.hpp"
#include "ball.hpp"
#include "durations.hpp"
#include "gait.hpp"
#include "surefoot/core/policy.hpp"
#include "surefoot/core/rng.hpp"
#include "walk_log.hpp"

namespace sigmaban {

struct WalkLoopOptions {
  double rate_hz = 100;
  double longest_walk_s = std::numeric_limits<double>::infinity();  // after which it stops [s]
  GaitOptions gait;
};

/// Why a walk ended.
enum class WalkEnd : std::uint8_t { asked, time, kick, lost, alarm };

constexpr std::string_view in_words(WalkEnd end) {
  switch (end) {
    case WalkEnd::asked:
      return "stopped as asked";
    case WalkEnd::time:
      return "stopped after its time";
    case WalkEnd::kick:
      return "stands where it may kick";
    case WalkEnd::lost:
      return "lost the ball";
    case WalkEnd::alarm:
      break;
  }
  return "stopped: a servo is too hot or its voltage is wrong";
}

/// Something that happened to a servo, or to all (no joint).
struct WalkEvent {
  double time = 0;  // since the start [s]
  dynamixel::ServoEvent what;
};

struct WalkReport {
  WalkEnd end = WalkEnd::asked;
  std::uint64_t ticks = 0;
  std::uint64_t overruns = 0;     // ticks that were not over when the next one was due
  std::uint64_t unreachable = 0;  // ticks in which the engine gave no targets: the servos kept theirs
  int walk_cycles = 0;            // with the policy in charge
  Durations lateness;             // of the start of ticks
  Durations thinking;             // ball, policy, gait and engine
  Durations ticking;              // from the start to the end of a tick
  std::vector<WalkEvent> events;  // the first hundred
};

/// Until the gait is done. `stop` is asked in every tick. Where it throws, the torque is off. Nothing is allocated
/// while it runs, unless policy or ball do.
template <class Problem, surefoot::Policy<Problem> Policy, BallSource Ball, WalkEngine Engine, class Group, class Stop>
void run_walk(const Problem& problem, const Policy& policy, Ball& ball, Engine engine, Group& group, WalkLog& log,
              const WalkLoopOptions& options, const surefoot::Rng& rng, Stop&& stop, WalkReport& report) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
  const double dt = 1 / options.rate_hz;
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(dt));
  auto&& acting = surefoot::start_of_run<Problem>(policy, rng);
  Gait gait(options.gait);
  surefoot::Vec<3> before = surefoot::Vec<3>::Zero();  // speed of the cycle before
  std::optional<BallView> view;
  std::array<double, 12> goals = {};
  for (std::size_t i = 0; i < goals.size(); ++i) goals[i] = group.states()[i].position_rad;
  report.events.reserve(100);
  LogRow row;
  const auto end = [&](WalkEnd why) {
    if (gait.stage() == GaitStage::slow_down || gait.stage() == GaitStage::settle) return;
    report.end = why;
    gait.stop();
  };

  bool cycle_begins = true;
  double walked = 0;
  const Clock::time_point begin = Clock::now();
  Clock::time_point due = begin;
  while (gait.stage() != GaitStage::done) {
    std::this_thread::sleep_until(due);
    const Clock::time_point start = Clock::now();
    if (stop()) end(WalkEnd::asked);

    const bool stepping = gait.stage() == GaitStage::step_in_place || gait.stage() == GaitStage::walk ||
                          gait.stage() == GaitStage::slow_down;
    if (stepping && cycle_begins) {
      const surefoot::Vec<3> speed = gait.speed();
      view = ball.see(speed, before);
      surefoot::Vec<3> wanted = problem.speed_after(speed, -speed);  // where nothing is seen: towards a halt
      if (gait.walking()) {
        if (view) {
          const auto seen = problem.arrive(view->x, view->y, view->angle, speed);
          if (seen.reward == 0) end(WalkEnd::kick);
          if (seen.terminal) end(WalkEnd::lost);
          wanted = problem.speed_after(speed, acting(seen.next));
        }
        ++report.walk_cycles;
      }
      gait.begin_cycle(wanted);
      before = speed;
    }
    const WalkOrders orders = gait.advance(dt);
    const double phase = engine.phase();
    const auto targets = engine.step(orders, stepping ? dt : 0);
    if (targets) goals = targets->array();
    if (!targets) ++report.unreachable;
    cycle_begins = engine.phase() < phase || !stepping;
    if (gait.walking() && (walked += dt) >= options.longest_walk_s) end(WalkEnd::time);
    const Clock::time_point thought = Clock::now();

    group.set_goals(goals);
    group.update();
    for (const dynamixel::ServoEvent& event : group.events()) {
      if (report.events.size() < report.events.capacity()) report.events.push_back({seconds(start - begin), event});
      if (event.kind == dynamixel::ServoEventKind::hot || event.kind == dynamixel::ServoEventKind::voltage_wrong) {
        end(WalkEnd::alarm);
      }
    }

    row.time = seconds(start - begin);
    row.orders = {orders.forward, orders.left, orders.turn};
    row.enabled = orders.enabled;
    row.phase = phase;
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    row.ball = view ? std::array{view->x, view->y, view->angle} : std::array{unknown, unknown, unknown};
    row.goals = goals;
    for (std::size_t i = 0; i < goals.size(); ++i) {
      const dynamixel::JointState& joint = group.states()[i];
      row.positions[i] = joint.fresh ? joint.position_rad : unknown;
      row.voltages[i] = joint.fresh ? joint.voltage_v : unknown;
    }
    row.lateness = seconds(start - due);
    log.add(row);

    const Clock::time_point over = Clock::now();
    ++report.ticks;
    report.lateness.add(seconds(start - due));
    report.thinking.add(seconds(thought - start));
    report.ticking.add(seconds(over - start));
    due += period;
    if (over > due) ++report.overruns;
    while (over > due + period) due += period;  // what was missed is not made up for
  }
}

}  // namespace sigmaban
