// Table of features of the motion, row by row: everything that a mismatch may depend on.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/diagnose/estimation/calibrate.hpp"

namespace surefoot::diagnosis {

struct FeatureTable {
  std::vector<std::string> names;
  Eigen::MatrixXd values;              // feature x sample
  std::vector<std::size_t> recording;  // by sample: place in the list of recordings
  std::vector<Eigen::Index> row;
};

/// Steps of a walk may differ in turn, as its legs do: by periods of up to so many.
constexpr int longest_gait = 4;

/// Which inputs are features of a row: its own, which act from then on; or those that acted until then, of the row
/// before. What a sensor reads depends on these only, but for inputs that an output shows at once. A controller makes
/// the inputs of a row from its readings and so passes on their noise, which would seem predictable by these.
enum class InputsOf { own_row, row_before };

/// Names of the features: states, sizes of velocities, time since their last reversal, inputs, `last(...)` where they
/// are those of the row before, and their changes, time (for maps also modulo 2 to 4), and whatever constants differ
/// between the recordings.
std::vector<std::string> feature_names(const BoundSimulator& bound, InputsOf inputs);

/// Every `stride`-th row of the recordings, along the given trajectories.
FeatureTable make_features(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                           const std::vector<SimulatedRun>& trajectories, Eigen::Index stride, InputsOf inputs);

/// The states alone.
FeatureTable only_states(const BoundSimulator& bound, const FeatureTable& all);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/features.ipp"
#endif
