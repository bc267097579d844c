// Data sets: the samples a regression learns from.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "surefoot/core/compiled.hpp"

namespace surefoot {

/// Samples, one per column. Inputs are float32 so that training classifies exactly as prediction does.
/// Inputs and Outputs may be Eigen::Dynamic.
template <int Inputs, int Outputs>
struct Dataset {
  Eigen::Matrix<float, Inputs, Eigen::Dynamic> inputs;
  Eigen::Matrix<double, Outputs, Eigen::Dynamic> outputs;
  Eigen::VectorXd weights;  // of the squared errors, positive; empty: all 1
};

namespace detail {

/// A data set whose sizes are not part of its type. One column per sample.
struct DatasetView {
  const float* inputs = nullptr;
  const double* outputs = nullptr;
  const double* weights = nullptr;  // null: all 1
  Eigen::Index input_rows = 0;
  Eigen::Index output_rows = 0;
  Eigen::Index count = 0;
};

template <int Inputs, int Outputs>
DatasetView view_of(const Dataset<Inputs, Outputs>& samples) {
  return {samples.inputs.data(), samples.outputs.data(), samples.weights.size() != 0 ? samples.weights.data() : nullptr,
          samples.inputs.rows(), samples.outputs.rows(), samples.inputs.cols()};
}

/// See check(Dataset). `outputs` columns and `weights` entries are there.
void check_samples(const DatasetView& samples, Eigen::Index outputs, Eigen::Index weights);

/// Of each output over all samples; 0 if it does not vary. The samples must have passed check().
std::vector<double> inverse_variances(const DatasetView& samples);

}  // namespace detail

/// Throws a ForestError that names the sample and field unless sizes agree and all numbers are finite.
template <int Inputs, int Outputs>
void check(const Dataset<Inputs, Outputs>& samples) {
  detail::check_samples(detail::view_of(samples), samples.outputs.cols(), samples.weights.size());
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/dataset.ipp"
#endif
