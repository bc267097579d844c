// The samples a regression learns from.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "surefoot/core/error.hpp"

namespace surefoot {

/// Samples, one per column. Inputs are float32 so that training classifies exactly as prediction does.
/// Inputs and Outputs may be Eigen::Dynamic.
template <int Inputs, int Outputs>
struct Dataset {
  Eigen::Matrix<float, Inputs, Eigen::Dynamic> inputs;
  Eigen::Matrix<double, Outputs, Eigen::Dynamic> outputs;
  Eigen::VectorXd weights;  // of the squared errors, positive; empty: all 1
};

/// Throws a ForestError that names the sample and field unless sizes agree and all numbers are finite.
template <int Inputs, int Outputs>
void check(const Dataset<Inputs, Outputs>& samples) {
  const Eigen::Index count = samples.inputs.cols();
  auto fail = [](const std::string& what) { throw ForestError("Dataset: " + what); };
  if (count == 0) fail("there are no samples (inputs has no columns)");
  if (samples.inputs.rows() == 0 || samples.outputs.rows() == 0)
    fail("needs at least one input row and one output row");
  if (samples.outputs.cols() != count) {
    fail("inputs has " + std::to_string(count) + " columns but outputs has " + std::to_string(samples.outputs.cols()));
  }
  if (samples.weights.size() != 0 && samples.weights.size() != count) {
    fail("weights must be empty or have one entry for each of the " + std::to_string(count) + " samples, got " +
         std::to_string(samples.weights.size()));
  }
  auto check_finite = [&](const auto& matrix, const char* field) {
    if (matrix.template cast<float>().allFinite()) return;  // trees keep their numbers in single precision
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
        if (!std::isfinite(static_cast<float>(matrix(row, i)))) {
          fail(std::string(field) + " " + std::to_string(row) + " of sample " + std::to_string(i) +
               " is not finite in single precision");
        }
      }
    }
  };
  check_finite(samples.inputs, "input");
  check_finite(samples.outputs, "output");
  for (Eigen::Index i = 0; i < samples.weights.size(); ++i) {
    const auto weight = static_cast<float>(samples.weights[i]);
    if (!(weight > 0) || !std::isfinite(weight)) {
      fail("weight of sample " + std::to_string(i) + " must be positive and finite in single precision, got " +
           std::to_string(samples.weights[i]));
    }
  }
}

}  // namespace surefoot
