// Sigmaban as calibrated by Hofer and Rouxel, ICAPS 2017: what stands in for a robot where none is at hand.
#pragma once

#include <filesystem>
#include <numbers>

#include "motion_file/motion_file.hpp"

namespace calibrate_program {

inline MotionFile paper_robot() {
  MotionFile file;
  file.kind = ModelKind::full;
  file.parameters.resize(12);
  file.parameters << 0.0093, 1.30, -0.17, 0.001,  // dx
      -0.0026, -0.075, 1.47, 0.101,               // dy
      0.0002, -0.35, 0.05, 0.909;                 // dt
  file.model = embedded(file.kind, file.parameters);
  file.covariance = 1e-12 * Eigen::MatrixXd::Identity(12, 12);
  file.noise = surefoot::UniformNoise{{0.02, 0.02, 5 * std::numbers::pi / 180}}.as_motion_noise();
  file.noise_shape_known = true;
  return file;
}

/// The robot of the paper if `path` is empty.
inline MotionFile robot_of(const std::filesystem::path& path) {
  return path.empty() ? paper_robot() : read_motion_file(path);
}

}  // namespace calibrate_program
