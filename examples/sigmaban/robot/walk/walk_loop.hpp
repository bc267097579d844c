// The control loop of the robot: ball, policy, gait, walk engine, servos, at a fixed rate of the monotonic clock.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "../bus/transport.hpp"
#include "../servos/servo_group.hpp"
#include "../walk_engine/walk_engine.hpp"
#include "approach_pilot.hpp"
#include "ball.hpp"
#include "durations.hpp"
#include "gait.hpp"
#include "stop_signals.hpp"
#include "surefoot/core/policy.hpp"
#include "surefoot/core/rng.hpp"
#include "walk_log.hpp"

namespace sigmaban {

struct WalkLoopOptions {
  double rate_hz = 100;
  double longest_walk_s = std::numeric_limits<double>::infinity();  // after which it stops [s]
  bool hold = false;                   // a walk that ends as it should keeps the torque on and stands; others never do
  std::vector<double> poses_rad = {};  // of the joints after the legs [rad]
  GaitOptions gait;
  FarBallCriteria far_ball;
  BallFilterCriteria ball = {};
};

/// Why a walk ended.
enum class WalkEnd : std::uint8_t { asked, time, kick, lost, alarm, fault, fell };

constexpr std::string_view in_words(WalkEnd end) {
  constexpr std::string_view words[] = {"stopped as asked",
                                        "stopped after its time",
                                        "stands where it may kick",
                                        "lost the ball",
                                        "stopped: a servo is too hot or its voltage is wrong",
                                        "gave up: something is wrong with a servo or the bus",
                                        "fell, and let go"};
  return words[static_cast<std::size_t>(end)];
}

/// May the robot go on standing with its torque on?
constexpr bool ended_well(WalkEnd end) { return end == WalkEnd::time || end == WalkEnd::kick || end == WalkEnd::lost; }

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
  double approach_s = 0;          // from the policy's first cycle until it stood still for one [s]
  Durations lateness;             // of the start of ticks
  Durations thinking;             // ball, policy, gait and engine
  Durations ticking;              // from the start to the end of a tick
  std::vector<WalkEvent> events;  // the first hundred
};

namespace walk_loop_detail {

/// One walk. `Acting` is what start_of_run() gives. Nothing is allocated in a tick, unless policy or ball do.
template <class Problem, class Acting, class Ball, class Engine, class Group>
class Walk {
 public:
  Walk(const Problem& problem, Acting& acting, Ball& ball, Engine engine, Group& group, const WalkLoopOptions& options,
       WalkReport& report)
      : ball_(&ball),
        pilot_(problem, acting, options.ball, options.far_ball),
        engine_(std::move(engine)),
        group_(&group),
        options_(options),
        report_(&report),
        gait_(options.gait) {
    for (const dynamixel::JointState& joint : group.states()) goals_.push_back(joint.position_rad);
    const std::size_t legs = goals_.size() - options.poses_rad.size();
    std::ranges::copy(options.poses_rad, goals_.begin() + static_cast<std::ptrdiff_t>(legs));
    report.events.reserve(100);
  }

  /// The robot stands with its torque on, and may, or its torque is off.
  bool over() const {
    if (!group_->torque_on()) return true;
    return gait_.stage() == GaitStage::done && options_.hold && ended_well(report_->end);
  }

  void obey(StopRequest request) {
    if (request == StopRequest::none) return;
    if (!hurries_) report_->end = WalkEnd::asked;
    hurries_ = true;
    gait_.stop_quickly();
    if (request == StopRequest::at_once) group_->let_go();
  }

  /// The goals of this tick.
  void think(double dt) {
    const GaitStage stage = gait_.stage();
    const bool stepping =
        stage == GaitStage::step_in_place || stage == GaitStage::walk || stage == GaitStage::slow_down;
    if (stepping && cycle_begins_) begin_cycle();
    orders_ = gait_.advance(dt);
    phase_ = engine_.phase();
    const auto targets = engine_.step(orders_, stepping ? dt : 0);
    if (targets) std::ranges::copy(targets->array(), goals_.begin());
    if (!targets) ++report_->unreachable;
    cycle_begins_ = engine_.phase() < phase_ || !stepping;
    if (gait_.walking() && (walked_ += dt) >= options_.longest_walk_s) end(WalkEnd::time);
    if (approaching_) report_->approach_s += dt;
  }

  /// Goals to the servos, and what they say. `time` since the start [s].
  void act(double time) {
    group_->set_goals(goals_);
    group_->update();
    if constexpr (requires { engine_.fallen(); }) {
      if (engine_.fallen()) fall();
    }
    for (const dynamixel::ServoEvent& event : group_->events()) {
      if (report_->events.size() < report_->events.capacity()) report_->events.push_back({time, event});
      using enum dynamixel::ServoEventKind;
      if (event.kind == hot) end(WalkEnd::alarm);
      if (event.kind == voltage_wrong) hurry(WalkEnd::alarm);
      if (event.kind == watchdog) hurry(WalkEnd::fault);
    }
    if (group_->fault()) hurry(WalkEnd::fault);
    if (gait_.stage() == GaitStage::done && !over() && !group_->sitting()) group_->sit_down();
  }

  LogRow row(double time, double lateness) const {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    LogRow row;
    row.time = time;
    row.orders = {orders_.forward, orders_.left, orders_.turn};
    row.enabled = orders_.enabled;
    row.phase = phase_;
    row.ball = view_ ? std::array{view_->x, view_->y, view_->angle} : std::array{unknown, unknown, unknown};
    for (std::size_t i = 0; i < goals_.size(); ++i) {
      const dynamixel::JointState& joint = group_->states()[i];
      row.goals[i] = group_->sent_goal(i);
      row.positions[i] = joint.fresh ? joint.position_rad : unknown;
      row.currents[i] = joint.fresh ? joint.current_a : unknown;
      row.voltages[i] = joint.fresh ? joint.voltage_v : unknown;
    }
    row.lateness = lateness;
    return row;
  }

 private:
  void end(WalkEnd why) {
    if (gait_.stage() >= GaitStage::slow_down) return;
    report_->end = why;
    gait_.stop();
  }
  void hurry(WalkEnd why) {
    if (!hurries_) report_->end = why;
    hurries_ = true;
    gait_.stop_quickly();
  }

  /// Nothing that moves helps a robot that lies.
  void fall() {
    if (report_->end == WalkEnd::fell) return;
    report_->end = WalkEnd::fell;
    hurries_ = true;
    gait_.stop_quickly();
    group_->let_go();
  }

  void begin_cycle() {
    const surefoot::Vec<3> speed = gait_.speed();
    approaching_ = gait_.walking() || (approaching_ && !speed.isZero());
    pilot_.walked(speed, before_);
    if (const auto seen = ball_->see(speed, before_)) pilot_.sighted(*seen);
    view_ = pilot_.ball();
    surefoot::Vec<3> wanted = speed;
    if (gait_.walking()) {
      const PilotDecision decision = pilot_.decide(speed);
      wanted = decision.speed;
      if (decision.may_kick) end(WalkEnd::kick);
      if (decision.lost) end(WalkEnd::lost);
      ++report_->walk_cycles;
    }
    gait_.begin_cycle(wanted);
    before_ = speed;
  }

  Ball* ball_;
  ApproachPilot<Problem, Acting> pilot_;
  Engine engine_;
  Group* group_;
  WalkLoopOptions options_;
  WalkReport* report_;
  Gait gait_;
  surefoot::Vec<3> before_ = surefoot::Vec<3>::Zero();  // speed of the cycle before
  std::optional<BallView> view_;
  std::vector<double> goals_;  // of the legs, then of the joints held in a pose [rad]
  WalkOrders orders_;
  double phase_ = 0, walked_ = 0;
  bool cycle_begins_ = true;
  bool hurries_ = false;
  bool approaching_ = false;  // the policy is in charge, or the robot still moves after it
};

}  // namespace walk_loop_detail

/// Until the robot sits limp or, where it may, stands; by the clock of the group's bus. `stop` is asked in every tick
/// for a StopRequest. Where it throws, the torque is off.
template <class Problem, surefoot::Policy<Problem> Policy, BallSource Ball, WalkEngine Engine, class Group, class Stop>
void run_walk(const Problem& problem, const Policy& policy, Ball& ball, Engine engine, Group& group, WalkLog& log,
              const WalkLoopOptions& options, const surefoot::Rng& rng, Stop&& stop, WalkReport& report) {
  using dynamixel::Time, dynamixel::to_seconds;
  const double dt = 1 / options.rate_hz;
  const Time period = dynamixel::from_seconds(dt);
  auto&& acting = surefoot::start_of_run<Problem>(policy, rng);
  walk_loop_detail::Walk walk(problem, acting, ball, std::move(engine), group, options, report);
  const Time begin = group.now();
  for (Time due = begin; !walk.over();) {
    group.wait_until(due);
    const Time start = group.now();
    walk.obey(stop());
    walk.think(dt);
    const Time thought = group.now();
    walk.act(to_seconds(thought - begin));
    log.add(walk.row(to_seconds(start - begin), to_seconds(start - due)));

    const Time over = group.now();
    ++report.ticks;
    report.lateness.add(to_seconds(start - due));
    report.thinking.add(to_seconds(thought - start));
    report.ticking.add(to_seconds(over - start));
    due += period;
    if (over > due) ++report.overruns;
    while (over > due + period) due += period;  // what was missed is not made up for
  }
}

}  // namespace sigmaban
