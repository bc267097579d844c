// `plan`: the commands of an experiment, and the sheet to note where the robot ended.
#include "surefoot/motion/plan.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "../common/files.hpp"
#include "commands.hpp"
#include "paper_robot.hpp"
#include "sheet_page.hpp"
#include "walk_csv.hpp"

namespace calibrate_program {
namespace {

struct PlanOptions {
  int sequences = 25, cycles = 25;
  std::uint64_t seed = 1;
  double steps_per_cycle = 1;
  std::string kind = "wandering";
  std::vector<double> low, high, acceleration;
  std::filesystem::path motion, out;
};

surefoot::CommandBounds bounds_of(const PlanOptions& options) {
  surefoot::CommandBounds bounds;
  const auto set = [](const std::vector<double>& given, surefoot::Vec<3>& bound) {
    for (std::size_t i = 0; i < given.size(); ++i) bound[static_cast<Eigen::Index>(i)] = given[i];
  };
  set(options.low, bounds.low);
  set(options.high, bounds.high);
  set(options.acceleration, bounds.acceleration);
  return bounds;
}

std::vector<Eigen::Matrix3Xd> plan_of(const PlanOptions& options, const MotionFile& robot) {
  const surefoot::CommandBounds bounds = bounds_of(options);
  if (options.kind == "wandering") {
    return surefoot::plan_commands(bounds, options.sequences, options.cycles, options.seed);
  }
  check(bounds);
  surefoot::MotionTracker tracker{.model = options.motion.empty() ? surefoot::FullLinearCorrection()
                                                                  : robot.model.present()};
  tracker.noise = robot.noise;
  return surefoot::plan_informative_commands(
      tracker, {.bounds = bounds, .sequences = options.sequences, .cycles = options.cycles}, options.seed);
}

void run(const PlanOptions& options) {
  const MotionFile robot = robot_of(options.motion);
  const std::vector<Eigen::Matrix3Xd> commands = plan_of(options, robot);
  const surefoot::PreviousCommandCorrection model =
      options.motion.empty() ? surefoot::PreviousCommandCorrection() : robot.model;
  constexpr int runs = 40;
  const surefoot::Box<2> space = surefoot::space_needed(model, robot.noise, std::span(commands), runs, options.seed);
  example::write_text(options.out / "commands.csv", commands_csv(commands, options.steps_per_cycle));
  example::write_text(options.out / "sheet.csv", blank_sheet_csv(commands.size()));
  example::write_text(options.out / "sheet.html", sheet_page(commands, space));
  std::printf(
      "%d sequences of %d cycles. In 99 %% of walks %s stays within %.1f m ahead of the start, %.1f m behind "
      "it,\n%.1f m to its left and %.1f m to its right.\n",
      options.sequences, options.cycles, options.motion.empty() ? "a robot that does what it is told" : "the robot",
      space.high()[0], -space.low()[0], space.high()[1], -space.low()[1]);
  std::printf(
      "In %s: commands.csv (give the robot one sequence after the other), sheet.html (print and fill in), "
      "sheet.csv (or fill in this).\n",
      options.out.c_str());
}

}  // namespace

void add_plan(example::Command& program) {
  auto options = std::make_shared<PlanOptions>();
  example::Command* command =
      program.add_subcommand("plan", "Plan the sequences to walk, and print a sheet for the results");
  command->add_option("--sequences", options->sequences, "how many")
      ->check(example::between(1, 10'000))
      ->capture_default_str();
  command->add_option("--cycles", options->cycles, "of each sequence; 25 are 15 s at 1.7 Hz")
      ->check(example::between(1, 10'000))
      ->capture_default_str();
  command
      ->add_option("--kind", options->kind,
                   "wandering: random accelerations, as published; informative: those of many that tell most about "
                   "the coefficients")
      ->check(example::one_of({"wandering", "informative"}))
      ->capture_default_str();
  command
      ->add_option("--steps-per-cycle", options->steps_per_cycle, "the file holds commands per step, this many a cycle")
      ->check(example::between(1e-3, 1e3))
      ->capture_default_str();
  const auto bounds = [&](const char* name, std::vector<double>& values, const char* what) {
    command->add_option(name, values, what)->delimiter(',')->expected(3);
  };
  bounds("--low", options->low, "least command of a cycle X,Y,TURN [m,m,rad]; default -0.04,-0.04,-0.4");
  bounds("--high", options->high, "largest command of a cycle; default 0.08,0.04,0.4");
  bounds("--acceleration", options->acceleration, "largest change from cycle to cycle; default 0.04,0.02,0.3");
  command->add_option("--motion", options->motion, "motion.json of the robot, to say what space it needs")
      ->check(example::existing_file());
  command->add_option("--seed", options->seed, "same seed, same commands")->capture_default_str();
  command->add_option("--out", options->out, "folder for the plan, made if needed")->required();
  command->callback([options] { run(*options); });
}

}  // namespace calibrate_program
