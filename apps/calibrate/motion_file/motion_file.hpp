// The file motion.json, "surefoot.motion/1": a calibrated motion model, how well it is known, and the noise of the
// walk. Needs nothing but the library and, in its .cpp, nlohmann-json, so that any program may read it.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "../model_kind.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace calibrate_program {

/// Errors of final poses of sequences that a model was not fitted to.
struct EvaluatedModel {
  std::string model;
  int parameters = 0;           // 0: the commands as they are
  double position = 0;          // root mean square [m]
  double position_error = NAN;  // its standard error [m]; NaN: not known
  double heading = NAN;         // root mean square [rad]; NaN: not measured
  bool chosen = false;
};

struct MotionFile {
  ModelKind kind = ModelKind::full;
  surefoot::PreviousCommandCorrection model;  // any kind; coefficients it does not have are 0
  Eigen::VectorXd parameters;                 // of the kind's own vector
  Eigen::MatrixXd covariance;                 // of those
  surefoot::MotionNoise noise;
  bool noise_shape_known = false;
  surefoot::PoseAccuracy accuracy;  // of the poses it was calibrated from
  double steps_per_cycle = 1;       // a perfect robot moves by this times its command in a cycle
  std::string method;               // "published", "likelihood" or "update"
  std::size_t sequences = 0;        // calibrated from
  std::size_t readings = 0;         // coordinates measured in them
  std::uint64_t seed = 1;
  std::vector<EvaluatedModel> heldout;  // by cross-validation
  std::vector<EvaluatedModel> test;     // on held-out sequences
};

std::string motion_file_text(const MotionFile& file);

/// Throws surefoot::MotionError that names `name` and the field.
MotionFile parse_motion_file(std::string_view text, const std::string& name);

MotionFile read_motion_file(const std::filesystem::path& path);

/// Never leaves a file half written.
void write_motion_file(const std::filesystem::path& path, const MotionFile& file);

}  // namespace calibrate_program
