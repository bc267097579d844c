// surefoot-walk: a policy on the robot. Ball, policy, walk engine and servos, on hardware or on virtual servos.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "../../../../apps/common/command.hpp"
#include "../../approach/commands.hpp"
#include "../policy_option.hpp"
#include "joints_file.hpp"
#include "walk_run.hpp"

namespace sigmaban {
namespace {

void add_run(example::Command& program) {
  auto options = std::make_shared<WalkRun>();
  example::Command* command = program.add_subcommand("run", "Stand up, walk to the ball, stop");
  add_problem_option(*command, options->problem);
  add_motion_option(*command, options->motion);
  command->add_option("--policy", options->policy, policy_help)->capture_default_str();
  command
      ->add_option(
          "--port", options->ports,
          "such as /dev/ttyUSB0, several with commas, in the order that the joints file numbers them; virtual: "
          "simulated servos in this program")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--baud", options->bits_per_s, "[bit/s]")->capture_default_str();
  command->add_flag(
      "--fast-sync-read", options->fast_sync_read,
      "servos answer in one packet (Protocol 2.0, new firmware); what it does not bring is asked as usual");
  command->add_option("--protocol", options->protocol, "of the servos")
      ->check(example::one_of({1, 2}))
      ->capture_default_str();
  command->add_option("--joints", options->joints_file, "JSON file: which servo moves which joint (see joints)")
      ->check(example::existing_file());
  auto* ball =
      command->add_option("--ball", options->ball, "simulated ball at x, y [m], kick direction [rad]; else at random")
          ->expected(3);
  command
      ->add_option("--ball-from", options->ball_from,
                   "file, named pipe or -: a line x y kick [m, m, rad] for each sight of the ball; no simulated ball")
      ->excludes(ball);
  auto* body =
      command->add_option("--body-from", options->body.from,
                          "file or named pipe: a line for each reading of gyroscope (x y z) [rad/s], "
                          "accelerometer (x y z) [m/s^2], loads under the feet (left right) [N], their centres ahead "
                          "of each foot's middle [m]; the walk is stabilised by them, and a fall ends it");
  command
      ->add_option("--body-port", options->body.port,
                   "the same from an inertial unit and load cells in the feet on a port of their own, Protocol 1.0")
      ->excludes(body);
  command->add_option("--body-baud", options->body.bits_per_s, "[bit/s]")->capture_default_str();
  command->add_option("--body-ids", options->body.devices.ids, "of inertial unit, left foot, right foot")
      ->check(example::between(0, 253))
      ->capture_default_str();
  command
      ->add_option("--unloaded-counts", options->body.devices.unloaded_counts, "of the feet in the air, left and right")
      ->capture_default_str();
  command->add_option("--newton-per-count", options->body.devices.newton_per_count, "of the load cells")
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "of walking at most")
      ->check(example::between(0.0, 1e6))
      ->capture_default_str();
  command->add_option("--rate", options->rate_hz, "of the servos' goals [Hz]")
      ->check(example::between(10.0, 500.0))
      ->capture_default_str();
  command->add_option("--after", options->after, "off: sit down, then torque off; hold: go on standing")
      ->check(example::one_of({"off", "hold"}))
      ->capture_default_str();
  command
      ->add_option("--bus-watchdog", options->bus_watchdog_s,
                   "after which servos of Protocol 2.0 stop without instructions; 0: never [s]")
      ->check(example::between(0.0, 2.5))
      ->capture_default_str();
  command->add_option("--log", options->log, "recording (CSV) of every tick");
  command->add_option("--trunk-x", options->walk.trunk_x_offset, "of the trunk before the feet [m]")
      ->check(example::between(-0.05, 0.05))
      ->capture_default_str();
  command->add_option("--trunk-z", options->walk.trunk_z_offset, "by which the knees are bent [m]")
      ->check(example::between(0.0, 0.1))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of the simulated ball")->capture_default_str();
  command->footer("First try without a robot: --port virtual. Then with the robot hanging in the air.");
  command->callback([options] {
    if (run_walk_to_ball(*options).end == WalkEnd::fell) throw surefoot::Error("the robot fell; its torque is off");
  });
}

void add_joints(example::Command& program) {
  struct Options {
    bool all = false;
    std::size_t ports = 1;
  };
  auto options = std::make_shared<Options>();
  example::Command* command = program.add_subcommand("joints", "Print the file that --joints takes, with the defaults");
  command->add_flag("--all", options->all, "neck and arms, too, 20 joints: held in a pose");
  command->add_option("--ports", options->ports, "left leg, right leg, and neck and arms on so many ports")
      ->check(example::between(1, 3))
      ->capture_default_str();
  command->callback([options] {
    RobotJoints robot = default_joints(options->all);
    for (std::size_t i = 0; i < robot.ports.size(); ++i)
      robot.ports[i] = std::min<std::size_t>(i / 6, 2) % options->ports;
    std::printf("%s", joints_to_json(robot).c_str());
  });
}

}  // namespace
}  // namespace sigmaban

int main(int argc, char** argv) {
  example::Command program{"A trained policy on the robot: ball, policy, walk engine, servos", "surefoot-walk"};
  program.require_subcommand(1);
  sigmaban::add_run(program);
  sigmaban::add_joints(program);
  return example::run_program(program, argc, argv);
}
