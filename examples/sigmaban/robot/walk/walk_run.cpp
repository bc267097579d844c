#include "walk_run.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "../../../../apps/common/interrupt.hpp"
#include "../../approach/motion.hpp"
#include "../bus/background_port.hpp"
#include "../bus/realtime.hpp"
#include "../bus/serial_port.hpp"
#include "../policy_option.hpp"
#include "../virtual_bus/virtual_bus.hpp"
#include "joints_file.hpp"
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
    const bool of_all = event.what.kind == dynamixel::ServoEventKind::watchdog;
    std::printf("%8.2f s  %s %s\n", event.time, of_all ? "the watchdog" : joints[event.what.joint].name.c_str(),
                std::string(in_words(event.what.kind)).c_str());
  }
  if (log.lost() > 0) std::printf("%llu rows of the log were lost\n", static_cast<unsigned long long>(log.lost()));
  if (log.failed()) std::printf("the log could not be written to its end: is the disk full?\n");
}

template <class Protocol, class Problem, class Policy, BallSource Ball>
void walk(const Problem& problem, const Policy& policy, Ball& ball, const WalkRun& options,
          const std::vector<dynamixel::Joint>& joints, WalkLog& log, const example::Interrupt& interrupt) {
  using namespace dynamixel;
  constexpr bool first = std::is_same_v<Protocol, Protocol1>;
  const ServoModel& model = first ? mx_64_protocol_1 : mx_64_protocol_2;
  const bool realtime = ask_for_realtime();
  std::optional<VirtualBus<Protocol>> line;
  if (options.port == "virtual") {
    std::vector<VirtualServo> servos;
    for (const Joint& joint : joints) servos.emplace_back(model, joint.id, servo_angle(joint, 0));
    line.emplace(Answerer<Protocol>(servos, {.bits_per_s = options.bits_per_s, .seed = options.seed}));
  }
  using Line = Bus<Protocol, BackgroundPort<SerialPort>>;
  Line bus(BackgroundPort(SerialPort(line ? line->path() : options.port, options.bits_per_s)),
           {.return_delay_s = line ? 0 : 500e-6, .latency_s = 1.5e-3});
  WalkLoopOptions loop{.rate_hz = options.rate_hz, .longest_walk_s = options.seconds, .gait = {}};
  loop.gait.slowing = problem.constants.max_acceleration;
  ServoGroup<Line> group(bus, model, joints,
                         {.soft_start_s = loop.gait.rise_s - 0.5, .listen_s = 0.7 / options.rate_hz});
  const auto report = std::make_unique<WalkReport>();
  std::printf("%zu servos on %s, %g Hz, %s; Ctrl-C stops the walk\n", joints.size(),
              line ? ("virtual bus " + line->path()).c_str() : options.port.c_str(), options.rate_hz,
              realtime ? "real-time priority" : "no real-time priority");
  std::fflush(stdout);
  group.start();
  run_walk(
      problem, policy, ball, SplineWalk(options.walk), group, log, loop, surefoot::Rng(options.seed, 1),
      [&] { return interrupt.requested(); }, *report);
  if (options.after == "hold") {
    group.keep_torque();
  } else {
    group.stop();
  }
  print(*report, bus, joints, log);
}

template <class Problem>
void run_problem(const Problem& problem, const WalkRun& options) {
  std::vector<dynamixel::Joint> joints =
      options.joints_file.empty() ? default_joints() : read_joints(options.joints_file);
  dynamixel::check_joints(joints, joints.size());
  const AnyPolicyOf<Problem> policy = load_policy_option(problem, options.policy, options.motion);
  const example::Interrupt interrupt;
  WalkLog log(options.log);
  const auto go = [&](auto& ball) {
    std::visit(
        [&](const auto& p) {
          if (options.protocol == 1) {
            walk<dynamixel::Protocol1>(problem, p, ball, options, joints, log, interrupt);
          } else {
            walk<dynamixel::Protocol2>(problem, p, ball, options, joints, log, interrupt);
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
  if (interrupt.requested()) throw example::Interrupted{};
}

}  // namespace

void run_walk_to_ball(const WalkRun& options) {
  with_problem(options.problem, options.motion, [&](const auto& problem) { run_problem(problem, options); });
}

}  // namespace sigmaban
