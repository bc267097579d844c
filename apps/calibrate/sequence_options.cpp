#include "sequence_options.hpp"

#include <cmath>
#include <iostream>
#include <numbers>

#include "../common/usage_error.hpp"

namespace calibrate_program {

using example::UsageError;

void add_reading_options(example::Command& command, SequenceOptions& options) {
  command.add_option("files", options.files, "recordings (CSV)")->required();
  add_layout_options(command, options);
}

void add_layout_options(example::Command& command, SequenceOptions& options) {
  ColumnNames& columns = options.load.columns;
  command
      .add_option("--steps-per-cycle", options.load.steps_per_cycle,
                  "a perfect robot moves by this times its command in a cycle; default: what a first line "
                  "`# steps_per_cycle: N` says, else 1")
      ->check(example::between(1e-3, 1e3));
  command
      .add_option("--commands,--orders", columns.commands,
                  "columns of the commands X,Y,TURN, if they are not recognised")
      ->delimiter(',')
      ->expected(3);
  command.add_option("--pose", columns.pose, "columns of the pose X,Y,HEADING (or X,Y), if they are not recognised")
      ->delimiter(',')
      ->expected(2, 3);
  command.add_option("--wheels", columns.wheels, "columns of the speeds of two wheels LEFT,RIGHT, instead of commands")
      ->delimiter(',')
      ->expected(2);
  command.add_option("--wheel-base", options.load.wheel_base, "[m] between the wheels")
      ->check(example::between(1e-3, 1e3));
  command.add_flag("--final-only", options.load.final_only, "use the final pose of each sequence alone");
}

void add_fitting_options(example::Command& command, SequenceOptions& options) {
  command
      .add_option(
          "--method", options.method,
          "likelihood: weighs each measured pose by what the noise makes of it; published: least errors of final "
          "poses (CMA-ES)")
      ->check(example::one_of({"likelihood", "published"}))
      ->capture_default_str();
  add_accuracy_options(command, options);
}

void add_accuracy_options(example::Command& command, SequenceOptions& options) {
  command.add_option("--position-accuracy", options.position_accuracy, "[m] of a measured position")
      ->check(example::between(0.0, 10.0))
      ->capture_default_str();
  command.add_option("--heading-accuracy", options.heading_accuracy, "[rad] of a measured heading")
      ->check(example::between(0.0, 3.0))
      ->capture_default_str();
  command
      .add_option("--heading-tolerance", options.heading_tolerance,
                  "[degrees] errors of headings below count as none; default: 15 if all headings are whole hours of a "
                  "clock, else 0; published: the paper's 30")
      ->check(example::between(0.0, 90.0));
}

void add_work_options(example::Command& command, SequenceOptions& options) {
  command.add_option("--seed", options.seed, "of all randomness; the same seed gives the same result")
      ->capture_default_str();
  command.add_option("--threads", options.threads, "0: as many as the machine has; results do not depend on it")
      ->check(example::between(0, 1024))
      ->capture_default_str();
}

void check(const SequenceOptions& options) {
  const bool wheels = !options.load.columns.wheels.empty();
  if (wheels && options.load.wheel_base <= 0) {
    throw UsageError("--wheels needs --wheel-base, the distance of the wheels [m]");
  }
  if (!wheels && options.load.wheel_base > 0) {
    throw UsageError("--wheel-base is for wheels; name the columns of their speeds by --wheels LEFT,RIGHT");
  }
  if (wheels && !options.load.columns.commands.empty()) throw UsageError("--commands and --wheels exclude each other");
  if (wheels && options.load.steps_per_cycle > 0) throw UsageError("--steps-per-cycle is not for --wheels");
}

FitSettings fit_settings(const SequenceOptions& options) {
  FitSettings settings;
  if (options.method == "published") settings.method = surefoot::FitMethod::published;
  settings.position_accuracy = options.position_accuracy;
  settings.heading_accuracy = options.heading_accuracy;
  if (options.heading_tolerance) settings.heading_tolerance = *options.heading_tolerance * std::numbers::pi / 180;
  settings.seed = options.seed;
  settings.progress = say;
  return settings;
}

void say(std::string_view what) { std::cerr << "... " << what << std::endl; }

void warn_of_skipped(const LoadedSequences& loaded) {
  if (!loaded.skipped.empty()) std::cerr << "warning: " << skipped_sentence(loaded) << '\n';
}

}  // namespace calibrate_program
