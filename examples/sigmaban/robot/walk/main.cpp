// surefoot-walk: a policy on the robot. Ball, policy, walk engine and servos, on hardware or on virtual servos.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "../../../../apps/common/run_program.hpp"
#include "../../approach/commands.hpp"
#include "../policy_option.hpp"
#include "joints_file.hpp"
#include "walk_run.hpp"

namespace sigmaban {
namespace {

void add_run(CLI::App& program) {
  auto options = std::make_shared<WalkRun>();
  CLI::App* command = program.add_subcommand("run", "Stand up, walk to the ball, stop");
  add_problem_option(*command, options->problem);
  add_motion_option(*command, options->motion);
  command->add_option("--policy", options->policy, policy_help)->capture_default_str();
  command->add_option("--port", options->port, "such as /dev/ttyUSB0; virtual: simulated servos in this program")
      ->capture_default_str();
  command->add_option("--baud", options->bits_per_s, "[bit/s]")->capture_default_str();
  command->add_option("--protocol", options->protocol, "of the servos")
      ->check(CLI::IsMember({1, 2}))
      ->capture_default_str();
  command->add_option("--joints", options->joints_file, "JSON file: which servo moves which joint (see joints)")
      ->check(CLI::ExistingFile);
  auto* ball =
      command->add_option("--ball", options->ball, "simulated ball at x, y [m], kick direction [rad]; else at random")
          ->expected(3);
  command
      ->add_option("--ball-from", options->ball_from,
                   "file, named pipe or -: a line x y kick [m, m, rad] for each sight of the ball; no simulated ball")
      ->excludes(ball);
  command->add_option("--seconds", options->seconds, "of walking at most")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  command->add_option("--rate", options->rate_hz, "of the servos' goals [Hz]")
      ->check(CLI::Range(10.0, 500.0))
      ->capture_default_str();
  command->add_option("--after", options->after, "off: sit down, then torque off; hold: go on standing")
      ->check(CLI::IsMember({"off", "hold"}))
      ->capture_default_str();
  command
      ->add_option("--bus-watchdog", options->bus_watchdog_s,
                   "after which servos of Protocol 2.0 stop without instructions; 0: never [s]")
      ->check(CLI::Range(0.0, 2.5))
      ->capture_default_str();
  command->add_option("--log", options->log, "recording (CSV) of every tick");
  command->add_option("--trunk-x", options->walk.trunk_x_offset, "of the trunk before the feet [m]")
      ->check(CLI::Range(-0.05, 0.05))
      ->capture_default_str();
  command->add_option("--trunk-z", options->walk.trunk_z_offset, "by which the knees are bent [m]")
      ->check(CLI::Range(0.0, 0.1))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of the simulated ball")->capture_default_str();
  command->footer("First try without a robot: --port virtual. Then with the robot hanging in the air.");
  command->callback([options] { run_walk_to_ball(*options); });
}

}  // namespace
}  // namespace sigmaban

int main(int argc, char** argv) {
  CLI::App program{"A trained policy on the robot: ball, policy, walk engine, servos", "surefoot-walk"};
  program.require_subcommand(1);
  sigmaban::add_run(program);
  program.add_subcommand("joints", "Print the file that --joints takes, with the defaults")->callback([] {
    std::printf("%s", sigmaban::joints_to_json(sigmaban::default_joints()).c_str());
  });
  return example::run_program(program, argc, argv);
}
