#include "walk_run.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "../../../../apps/common/usage_error.hpp"
#include "../../approach/motion.hpp"
#include "../bus/background_port.hpp"
#include "../bus/realtime.hpp"
#include "../bus/serial_port.hpp"
#include "../policy_option.hpp"
#include "../servos/torque_guard.hpp"
#include "../virtual_bus/virtual_bus.hpp"
#include "joints_file.hpp"
#include "sitting_pose.hpp"
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

template <class Bus>
void print(const WalkReport& report, Bus& bus, const std::vector<dynamixel::Joint>& joints, const WalkLog& log) {
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
  dynamixel::ServoStatistics sum;
  for (const dynamixel::Joint& joint : joints) sum += bus.statistics(joint.id);
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

dynamixel::ServoGroupOptions group_options(const WalkRun& options, const WalkLoopOptions& loop, bool is_virtual,
                                           dynamixel::TorqueGuard* guard) {
  dynamixel::ServoGroupOptions group;
  group.soft_start_s = loop.gait.rise_s - 0.5;
  group.listen_s = 0.75 / options.rate_hz;
  group.care.poll_s = 0.2 / options.rate_hz;
  group.bus_watchdog_s = options.bus_watchdog_s;
  group.guard = guard;
  if (is_virtual) group.watchdog_s = group.care.group.line_is_dead_s = 1;  // a machine that simulates may stand still
  if (const auto sitting = sitting_pose(options.walk)) {
    const auto angles = sitting->array();
    group.sitting_rad.assign(angles.begin(), angles.end());
  }
  return group;
}

template <class Protocol>
std::optional<dynamixel::VirtualBus<Protocol>> virtual_line(const WalkRun& options, const dynamixel::ServoModel& model,
                                                            const std::vector<dynamixel::Joint>& joints) {
  using namespace dynamixel;
  if (options.port != "virtual") return std::nullopt;
  std::vector<VirtualServo> servos;
  for (const Joint& joint : joints) servos.emplace_back(model, joint.id, servo_angle(joint, 0));
  return std::optional<VirtualBus<Protocol>>(
      std::in_place, Answerer<Protocol>(servos, {.bits_per_s = options.bits_per_s, .seed = options.seed}));
}

template <class Protocol, class Problem, class Policy, BallSource Ball>
void walk(const Problem& problem, const Policy& policy, Ball& ball, const WalkRun& options,
          const std::vector<dynamixel::Joint>& joints, WalkLog& log, StopSignals& signals) {
  using namespace dynamixel;
  constexpr bool first = std::is_same_v<Protocol, Protocol1>;
  const ServoModel& model = first ? mx_64_protocol_1 : mx_64_protocol_2;
  const bool realtime = ask_for_realtime();
  auto line = virtual_line<Protocol>(options, model, joints);
  using Line = Bus<Protocol, BackgroundPort<SerialPort>>;
  Line bus(BackgroundPort(SerialPort(line ? line->path() : options.port, options.bits_per_s)),
           {.return_delay_s = line ? 0 : 500e-6, .latency_s = 1.5e-3});
  WalkLoopOptions loop{.rate_hz = options.rate_hz,
                       .longest_walk_s = options.seconds,
                       .hold = options.after == "hold",
                       .gait = {},
                       .far_ball = {}};
  loop.gait.slowing = problem.constants.max_acceleration;
  std::optional<TorqueGuard> guard;  // virtual servos end with this program
  if (!line) guard.emplace(bus.port().port().file(), TorqueGuardOptions{.name = "surefoot-walk: torque guard"});
  ServoGroup<Line> group(bus, model, joints, group_options(options, loop, line.has_value(), guard ? &*guard : nullptr));
  const auto report = std::make_unique<WalkReport>();
  std::printf("%zu servos on %s, %g Hz, %s; Ctrl-C stops the walk, twice lets go\n", joints.size(),
              line ? ("virtual bus " + line->path()).c_str() : options.port.c_str(), options.rate_hz,
              realtime ? "real-time priority" : "no real-time priority");
  std::fflush(stdout);
  group.start();
  run_walk(
      problem, policy, ball, SplineWalk(options.walk), group, log, loop, surefoot::Rng(options.seed, 1),
      [&] { return signals.request(); }, *report);
  const bool held = group.torque_on();
  if (held) group.keep_torque();
  signals.no_more_deadlines();
  print(*report, bus, joints, log);
  if (!held && group.unconfirmed() > 0) {
    std::printf("%zu servos did not say that their torque is off\n", group.unconfirmed());
  }
  if (report->end == WalkEnd::alarm || report->end == WalkEnd::fault) {
    throw BusError(fault_in_words(group.fault(), report->end, joints));
  }
}

template <class Problem>
void run_problem(const Problem& problem, const WalkRun& options) {
  std::vector<dynamixel::Joint> joints =
      options.joints_file.empty() ? default_joints() : read_joints(options.joints_file);
  dynamixel::check_joints(joints, joints.size());
  const AnyPolicyOf<Problem> policy = load_policy_option(problem, options.policy, options.motion);
  StopSignals signals;
  WalkLog log(options.log);
  const auto go = [&](auto& ball) {
    std::visit(
        [&](const auto& p) {
          if (options.protocol == 1) {
            walk<dynamixel::Protocol1>(problem, p, ball, options, joints, log, signals);
          } else {
            walk<dynamixel::Protocol2>(problem, p, ball, options, joints, log, signals);
          }
        },
        policy);
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
}

}  // namespace

void run_walk_to_ball(const WalkRun& options) {
  with_problem(options.problem, options.motion, [&](const auto& problem) { run_problem(problem, options); });
}

}  // namespace sigmaban
