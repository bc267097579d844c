#include "walk_run.hpp"

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "../../../../apps/common/usage_error.hpp"
#include "../../approach/motion.hpp"
#include "../balance/stabilized_walk.hpp"
#include "../bus/realtime.hpp"
#include "../policy_option.hpp"
#include "joints_file.hpp"
#include "robot_lines.hpp"
#include "stop_signals.hpp"
#include "walk_loop.hpp"

namespace sigmaban {
namespace {

template <class Problem>
BallView simulated_start(const Problem& problem, const WalkRun& options) {
  if (!options.ball.empty()) return {options.ball[0], options.ball[1], options.ball[2]};
  surefoot::Rng rng(options.seed, 0);
  const typename Problem::State state = problem.initial_state(rng);
  return {state[0] * std::cos(state[1]), state[0] * std::sin(state[1]), state[2]};
}

void print(const WalkReport& report, const dynamixel::ServoStatistics& sum, const std::vector<dynamixel::Joint>& joints,
           const WalkLog& log) {
  std::printf("The robot %s.\n", std::string(in_words(report.end)).c_str());
  std::printf("%llu ticks, %d walk cycles by the policy; %llu overruns; %llu ticks without targets\n",
              static_cast<unsigned long long>(report.ticks), report.walk_cycles,
              static_cast<unsigned long long>(report.overruns), static_cast<unsigned long long>(report.unreachable));
  std::printf("%-34s %9s %9s %9s %9s\n", "microseconds", "median", "p99", "p99.9", "longest");
  const auto line = [](const char* what, const Durations& d) {
    std::printf("%-34s %9.0f %9.0f %9.0f %9.0f\n", what, 1e6 * d.percentile(0.5), 1e6 * d.percentile(0.99),
                1e6 * d.percentile(0.999), 1e6 * d.longest());
  };
  line("lateness of a tick", report.lateness);
  line("ball, policy and walk engine", report.thinking);
  line("whole tick, with the bus", report.ticking);
  std::printf("servos asked %llu times: %llu answered, %llu lost, %llu corrupted\n",
              static_cast<unsigned long long>(sum.asked), static_cast<unsigned long long>(sum.answered),
              static_cast<unsigned long long>(sum.lost), static_cast<unsigned long long>(sum.corrupted));
  for (const WalkEvent& event : report.events) {
    const bool of_all = is_of_all(event.what.kind);
    const bool watchdog = event.what.kind == dynamixel::ServoEventKind::watchdog;
    std::printf("%8.2f s  %s %s\n", event.time,
                watchdog ? "the watchdog"
                : of_all ? "the robot"
                         : joints[event.what.joint].name.c_str(),
                std::string(in_words(event.what.kind)).c_str());
  }
  if (log.lost() > 0) std::printf("%llu rows of the log were lost\n", static_cast<unsigned long long>(log.lost()));
  if (log.failed()) std::printf("the log could not be written to its end: is the disk full?\n");
}

/// What went wrong, for a program that ends with it.
std::string fault_in_words(const std::optional<dynamixel::ServoFault>& fault, WalkEnd end,
                           const std::vector<dynamixel::Joint>& joints) {
  if (!fault) return "the robot " + std::string(in_words(end));
  const dynamixel::Joint& joint = joints[fault->joint];
  return "the robot gave up: joint " + joint.name + " (servo " + std::to_string(joint.id) + ") " +
         std::string(in_words(fault->finding));
}

WalkLoopOptions loop_options(const WalkRun& options, const RobotJoints& robot, const surefoot::Vec<3>& slowing) {
  WalkLoopOptions loop{.rate_hz = options.rate_hz,
                       .longest_walk_s = options.seconds,
                       .hold = options.after == "hold",
                       .poses_rad = robot.poses_rad,
                       .gait = {},
                       .far_ball = {}};
  loop.gait.slowing = slowing;
  return loop;
}

/// A policy of any kind: one type, so that a walk is compiled once for all.
template <class Problem>
using AnyPolicyFunction = std::function<typename Problem::Action(const typename Problem::State&)>;

template <class Protocol, class Problem, BallSource Ball>
WalkOutcome walk(const Problem& problem, const AnyPolicyFunction<Problem>& policy, Ball& ball, const WalkRun& options,
                 const RobotJoints& robot, WalkLog& log, StopSignals& signals) {
  const bool realtime = dynamixel::ask_for_realtime();
  const WalkLoopOptions loop = loop_options(options, robot, problem.constants.max_acceleration);
  RobotLines<Protocol> lines(options, robot, loop.gait.rise_s);
  const auto report = std::make_unique<WalkReport>();
  std::printf("%zu servos on %s, %g Hz, %s; Ctrl-C stops the walk, twice lets go\n", robot.joints.size(),
              lines.names().c_str(), options.rate_hz, realtime ? "real-time priority" : "no real-time priority");
  std::fflush(stdout);
  auto& group = lines.group();
  group.start();
  StabilizedWalk engine(SplineWalk(options.walk), RobotBody(options.body), 1 / options.rate_hz);
  run_walk(
      problem, policy, ball, std::move(engine), group, log, loop, surefoot::Rng(options.seed, 1),
      [&] { return signals.request(); }, *report);
  const bool held = group.torque_on();
  if (held) group.keep_torque();
  signals.no_more_deadlines();
  print(*report, lines.statistics(), robot.joints, log);
  if (!held && group.unconfirmed() > 0) {
    std::printf("%zu servos did not say that their torque is off\n", group.unconfirmed());
  }
  if (report->end == WalkEnd::alarm || report->end == WalkEnd::fault) {
    throw dynamixel::BusError(fault_in_words(group.fault(), report->end, robot.joints));
  }
  return {report->end, report->approach_s};
}

template <class Problem>
WalkOutcome run_problem(const Problem& problem, const WalkRun& options) {
  const RobotJoints robot = options.joints_file.empty() ? default_joints() : read_joints(options.joints_file);
  const AnyPolicyFunction<Problem> policy = std::visit([](auto loaded) -> AnyPolicyFunction<Problem> { return loaded; },
                                                       load_policy_option(problem, options.policy, options.motion));
  StopSignals signals;
  std::vector<std::string> names;
  for (const dynamixel::Joint& joint : robot.joints) names.push_back(joint.name);
  WalkLog log(options.log, names);
  WalkOutcome outcome;
  const auto go = [&](auto& ball) {
    outcome = options.protocol == 1 ? walk<dynamixel::Protocol1>(problem, policy, ball, options, robot, log, signals)
                                    : walk<dynamixel::Protocol2>(problem, policy, ball, options, robot, log, signals);
  };
  if (options.ball_from.empty()) {
    SimulatedBall<Problem> ball(problem, simulated_start(problem, options), surefoot::Rng(options.seed, 2));
    go(ball);
  } else {
    BallReader ball(options.ball_from);
    go(ball);
    if (ball.ignored() > 0) {
      std::printf("%llu lines of %s were no ball (x y kick) and were ignored\n",
                  static_cast<unsigned long long>(ball.ignored()), options.ball_from.c_str());
    }
  }
  if (signals.requested()) throw example::Interrupted{};
  return outcome;
}

}  // namespace

WalkOutcome run_walk_to_ball(const WalkRun& options) {
  WalkOutcome outcome;
  with_problem(options.problem, options.motion, [&](const auto& problem) { outcome = run_problem(problem, options); });
  return outcome;
}

}  // namespace sigmaban
