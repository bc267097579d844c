// `simulate`: what would be recorded of a robot.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "../common/files.hpp"
#include "commands.hpp"
#include "paper_robot.hpp"
#include "surefoot/motion/plan.hpp"
#include "surefoot/motion/simulate_walk.hpp"
#include "walk_csv.hpp"

namespace calibrate_program {
namespace {

struct SimulateOptions {
  int sequences = 25, cycles = 25;
  std::uint64_t seed = 1;
  double position_accuracy = 0.005, heading_accuracy = 0.02;  // [m], [rad]
  double heading_tolerance = 0;                               // [degrees]
  bool final_only = false;
  std::filesystem::path motion, out;
};

void run(const SimulateOptions& options) {
  const MotionFile robot = robot_of(options.motion);
  const surefoot::PoseAccuracy accuracy{.position = options.position_accuracy,
                                        .heading = options.heading_accuracy,
                                        .heading_tolerance = options.heading_tolerance * std::numbers::pi / 180};
  std::vector<surefoot::WalkSequence> sequences;
  for (const Eigen::Matrix3Xd& commands :
       surefoot::plan_commands(surefoot::CommandBounds(), options.sequences, options.cycles, options.seed)) {
    surefoot::Rng rng = surefoot::Rng(options.seed, sequences.size()).stream(2);
    sequences.push_back(simulate_walk(robot.model, robot.noise, accuracy,
                                      surefoot::planned_sequence(commands, !options.final_only), rng));
  }
  example::write_text(options.out, walks_csv(sequences, robot.steps_per_cycle));
  std::printf("%s: %d sequences of %d cycles\n", options.out.c_str(), options.sequences, options.cycles);
}

}  // namespace

void add_simulate(example::Command& program) {
  auto options = std::make_shared<SimulateOptions>();
  example::Command* command = program.add_subcommand(
      "simulate", "Write recordings of a simulated robot: that of the paper, or a calibrated one");
  command->add_option("--sequences", options->sequences, "how many")
      ->check(example::between(1, 100'000))
      ->capture_default_str();
  command->add_option("--cycles", options->cycles, "of each sequence")
      ->check(example::between(1, 10'000))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of commands and noise")->capture_default_str();
  command->add_option("--motion", options->motion, "motion.json of the robot; default: the robot of the paper");
  command->add_flag("--final-only", options->final_only, "the final pose of each sequence alone");
  command->add_option("--position-accuracy", options->position_accuracy, "[m] of a measured position")
      ->check(example::between(0.0, 10.0))
      ->capture_default_str();
  command->add_option("--heading-accuracy", options->heading_accuracy, "[rad] of a measured heading")
      ->check(example::between(0.0, 3.0))
      ->capture_default_str();
  command
      ->add_option("--heading-tolerance", options->heading_tolerance,
                   "[degrees] headings are read off in bins of twice this width; 15: whole hours of a clock")
      ->check(example::between(0.0, 90.0))
      ->capture_default_str();
  command->add_option("--out", options->out, "CSV file to write")->required();
  command->callback([options] { run(*options); });
}

}  // namespace calibrate_program
