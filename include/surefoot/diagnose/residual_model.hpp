// Residual model: a forest that has learned what a simulator leaves of its outputs, as a value and as a file.
//
// File, little-endian: char[8] "SUREFRES", u32 version (1), u32 features, u32 outputs, the name of each feature and of
// each output (u64 length, characters), f64 scale of each output, the forest (see forest/serialize.hpp), u64 checksum.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "surefoot/forest/forest.hpp"

namespace surefoot {

using ResidualForest = Forest<Eigen::Dynamic, Eigen::Dynamic, ConstantLeaf>;

/// Predicts simulated minus measured outputs from features of the simulated motion (see features.hpp).
struct ResidualModel {
  std::vector<std::string> features, outputs;  // names, in the order of the forest
  Eigen::VectorXd scale;                       // by output, in its unit: what a forest's output of 1 is
  ResidualForest forest;
};

void save_residual_model(const ResidualModel& model, const std::string& path);

/// Throws CoreError or ForestError if the file is damaged or of another kind.
ResidualModel load_residual_model(const std::string& path);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_model.ipp"
#endif
