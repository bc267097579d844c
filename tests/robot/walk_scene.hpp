// A walk on virtual servos in virtual time, with a fault put into it.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "examples/sigmaban/approach/approach.hpp"
#include "examples/sigmaban/robot/virtual_bus/memory_transport.hpp"
#include "examples/sigmaban/robot/walk/sitting_pose.hpp"
#include "examples/sigmaban/robot/walk/walk_loop.hpp"
#include "examples/sigmaban/robot/walk_engine/spline_walk.hpp"

namespace sigmaban {

using dynamixel::Time, dynamixel::from_seconds, dynamixel::to_seconds;

/// Always as far ahead.
struct StandingBall {
  std::optional<BallView> see(const surefoot::Vec<3>&, const surefoot::Vec<3>&) const { return BallView{0.8, 0, 0}; }
};

/// Forwards.
struct ForwardPolicy {
  Approach::Action operator()(const Approach::State&) const { return {0.01, 0, 0}; }
};

inline std::vector<dynamixel::Joint> leg_joints() {
  std::vector<dynamixel::Joint> joints;
  for (const std::string_view name : joint_names) {
    joints.push_back({.name = std::string(name), .id = static_cast<std::uint8_t>(joints.size() + 1)});
  }
  return joints;
}

/// What became of the torque.
enum class Torque { all_on, all_off, held, some_on };

/// What a walk did about a fault.
struct SceneResult {
  std::string reaction;  // as in the table of the README
  double reacted_s = 0;  // after the fault [s]
  double limp_s = 0;     // after the fault, when the torque of all was off or held [s]
  Torque torque{};       // some time after the fault, or at the end where the walk ended
  Torque at_the_end{};   // when the program is gone
  std::string message;   // of what it threw
  WalkEnd end{};
};

/// `Protocol` is Protocol1 or Protocol2. The fault comes while the robot walks.
template <class Protocol>
class WalkScene {
 public:
  using Port = dynamixel::MemoryTransport<Protocol>;
  using Line = dynamixel::Bus<Protocol, Port>;
  using Group = dynamixel::ServoGroup<Line>;
  static constexpr const dynamixel::ServoModel& model =
      Protocol::version == 1 ? dynamixel::mx_64_protocol_1 : dynamixel::mx_64_protocol_2;
  static constexpr double fault_at_s = 2.2;   // by then it walks [s]
  static constexpr double watched_for_s = 4;  // then it is asked to stop [s]

  WalkScene() : answerer(servos(), {.seed = 3}), bus(Port(answerer), {.return_delay_s = 0, .latency_s = 200e-6}) {}

  /// once(): when the fault comes; always(): in each tick after it. Before the start: before().
  std::function<void()> before = [] {}, once = [] {}, always = [] {};
  std::function<StopRequest(double)> signal = [](double) { return StopRequest::none; };  // by the time after the fault
  std::vector<dynamixel::Joint> joints = leg_joints();

  SceneResult run() {
    SceneResult result;
    const auto report = std::make_unique<WalkReport>();
    before();
    try {
      Group group(bus, model, joints, options());
      const Time begun = now();
      group.start();
      walk(group, result, *report);
      result.reacted_s = to_seconds(now() - (fault_ ? *fault_ : begun));
      result.end = report->end;
      name_reaction(group, *report, result);
    } catch (const dynamixel::BusError& error) {
      result.message = error.what();
      result.reaction = fault_ ? "ends" : "refuses";
      result.reacted_s = to_seconds(now() - fault_.value_or(Time{}));
    }
    for (int i = 0; i < 100; ++i) pass();
    result.at_the_end = torque();
    if (result.reaction != "goes on" && result.reaction != "restores") result.torque = result.at_the_end;
    return result;
  }

  Torque torque() {
    std::size_t on = 0, held = 0;
    for (const dynamixel::VirtualServo& servo : answerer.servos()) {
      on += servo.torque_on() ? 1U : 0U;
      held += servo.torque_on() && servo.watchdog_tripped() ? 1U : 0U;
    }
    if (on == 0) return Torque::all_off;
    if (on == held) return Torque::held;
    return on == answerer.servos().size() ? Torque::all_on : Torque::some_on;
  }

  Time now() { return bus.port().now(); }
  dynamixel::VirtualServo& servo(std::uint8_t id) { return answerer.servo(id); }

  dynamixel::Answerer<Protocol> answerer;
  Line bus;

 private:
  static std::vector<dynamixel::VirtualServo> servos() {
    std::vector<dynamixel::VirtualServo> made;
    for (std::uint8_t id = 1; id <= 12; ++id) made.emplace_back(model, id, 0.02 * id);
    return made;
  }

  dynamixel::ServoGroupOptions options() const {
    dynamixel::ServoGroupOptions group;
    group.soft_start_s = 0.4;
    group.listen_s = 0.007;
    const auto sitting = sitting_pose({})->array();
    group.sitting_rad.assign(sitting.begin(), sitting.end());
    return group;
  }

  /// 10 ms in which nobody says anything.
  void pass() {
    bus.port().wait(from_seconds(0.01));
    answerer.advance(now());
  }

  void walk(Group& group, SceneResult& result, WalkReport& report) {
    const Approach problem;
    StandingBall ball;
    WalkLog log("");
    WalkLoopOptions loop{.gait = {.rise_s = 0.6, .slowing = problem.constants.max_acceleration}, .far_ball = {}};
    begin_ = now();
    run_walk(
        problem, ForwardPolicy{}, ball, SplineWalk(), group, log, loop, surefoot::Rng(1, 1),
        [&] { return tick(result); }, report);
  }

  StopRequest tick(SceneResult& result) {
    answerer.advance(now());
    const double time = to_seconds(now() - begin_);
    if (time < fault_at_s) return StopRequest::none;
    if (!fault_) {
      fault_ = now();
      once();
    }
    always();
    const double since = to_seconds(now() - *fault_);
    if (since > watched_for_s && since < watched_for_s + 0.015) result.torque = torque();
    return since > watched_for_s ? StopRequest::in_order : signal(since);
  }

  /// By the first event that is one.
  void name_reaction(const Group&, const WalkReport& report, SceneResult& result) {
    using enum dynamixel::ServoEventKind;
    const double fault = to_seconds(*fault_ - begin_);
    result.limp_s = result.reacted_s;
    result.reaction = "goes on";
    for (const WalkEvent& event : report.events) {
      const double since = event.time - fault;
      if (since < -0.001 || since > watched_for_s) continue;
      const auto react = [&](const char* reaction) {
        result.reaction = reaction;
        result.reacted_s = since;
      };
      if (event.what.kind == restored && result.reaction == "goes on") react("restores");
      if (event.what.kind == sitting) return react("sits down");
      if (event.what.kind == let_go || event.what.kind == watchdog) return react("lets go");
    }
  }

  Time begin_{};
  std::optional<Time> fault_;
};

}  // namespace sigmaban
