// The option --motion: the ball approach of a robot that was calibrated by surefoot-calibrate.
#pragma once

#include <filesystem>
#include <string>

#include "approach.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/previous_command_correction.hpp"

namespace example {
class Command;
}

namespace sigmaban {

/// With any linear walk and any noise that calibration knows.
using CalibratedApproach = ApproachWith<surefoot::PreviousCommandCorrection, surefoot::MotionNoise>;

void add_motion_option(example::Command& command, std::string& file);

CalibratedApproach calibrated_approach(const std::string& problem_name, const std::string& file);

/// A policy knows the walk of its robot: throws UsageError if the record beside a policy file says that it was trained
/// with another motion file, or with one while none is given now.
void check_motion(const std::filesystem::path& policy, const std::string& motion_file);

/// Calls run(problem) with the published problem of that name, or with the calibrated one if there is a file.
template <class Run>
void with_problem(const std::string& problem_name, const std::string& motion_file, Run&& run) {
  if (motion_file.empty()) {
    run(problem_named(problem_name));
  } else {
    run(calibrated_approach(problem_name, motion_file));
  }
}

}  // namespace sigmaban
