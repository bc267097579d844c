// From sequences to a motion file: compares the models, fits the one that predicts best, chooses the noise.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "motion_file/motion_file.hpp"
#include "stoppable.hpp"
#include "surefoot/motion/calibrate.hpp"
#include "surefoot/motion/compare.hpp"

namespace calibrate_program {

struct FitSettings {
  std::optional<ModelKind> kind;  // none: the one that predicts best
  surefoot::FitMethod method = surefoot::FitMethod::likelihood;
  double position_accuracy = 0.005;         // [m]
  double heading_accuracy = 0.02;           // [rad]
  std::optional<double> heading_tolerance;  // [rad]; none: 15 degrees if all headings are whole hours of a clock
  std::uint64_t seed = 1;
  std::function<void(std::string_view)> progress = [](std::string_view) {};
};

struct FittedWalk {
  MotionFile file;
  surefoot::NoiseChoice noise;
  Eigen::VectorXd by_other_method;    // the parameters
  std::vector<bool> determined;       // whether the commands tell the parameter
  std::vector<std::string> outliers;  // sentences about sequences that end where no model puts them
  bool headings_of_clock = false;     // recognised as such
};

/// What the settings make of these sequences. Throws surefoot::MotionError for too few sequences.
surefoot::PredictorOptions predictor_options(std::span<const surefoot::WalkSequence> sequences,
                                             const FitSettings& settings);

/// Sequences in `test` are used for MotionFile::test alone.
FittedWalk fit_walk(std::span<const surefoot::WalkSequence> sequences, std::span<const surefoot::WalkSequence> test,
                    const FitSettings& settings, const StoppableThreads& executor);

/// True if every heading is a multiple of 30 degrees: read off a clock.
bool headings_of_clock(std::span<const surefoot::WalkSequence> sequences);

/// Largest command of each component [m, m, rad]: what counts as full speed.
surefoot::Vec<3> command_scale(std::span<const surefoot::WalkSequence> sequences);

/// How many coordinates of poses were measured.
std::size_t count_readings(std::span<const surefoot::WalkSequence> sequences);

}  // namespace calibrate_program
