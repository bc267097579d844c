// How wrong a forest is on given samples.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"

namespace surefoot {

namespace detail {

/// Throws a ForestError that starts with `who` unless the forest can be compared with the samples.
template <int Inputs, int Outputs, LeafModel Leaf>
void check_fit(const Forest<Inputs, Outputs, Leaf>& forest, const Dataset<Inputs, Outputs>& samples,
               const std::string& who) {
  if (forest.empty()) throw ForestError(who + ": the forest is empty, train or load it first");
  check(samples);
  if (samples.inputs.rows() != forest.inputs() || samples.outputs.rows() != forest.outputs()) {
    throw ForestError(who + ": the samples have " + std::to_string(samples.inputs.rows()) + " inputs and " +
                      std::to_string(samples.outputs.rows()) + " outputs, but the forest " +
                      std::to_string(forest.inputs()) + " and " + std::to_string(forest.outputs()));
  }
}

}  // namespace detail

/// The share of the outputs' variance that the forest does not explain (1 - R2): 0 is perfect, 1 no better than their
/// mean. Several outputs: the mean of their shares; an output that does not vary in the samples is left out. Throws
/// ForestError if shapes differ or the forest is empty. One batch prediction.
template <int Inputs, int Outputs, LeafModel Leaf>
double unexplained(const Forest<Inputs, Outputs, Leaf>& forest, const Dataset<Inputs, Outputs>& samples) {
  detail::check_fit(forest, samples, "unexplained");
  typename Forest<Inputs, Outputs, Leaf>::BatchOutput predicted;
  forest.predict(samples.inputs, predicted);
  const std::vector<double> scale = detail::inverse_variances(samples);
  double sum = 0;
  double varying = 0;
  for (std::size_t o = 0; o < scale.size(); ++o) {
    if (scale[o] == 0) continue;
    const auto row = static_cast<Eigen::Index>(o);
    const auto squares = (predicted.row(row) - samples.outputs.row(row)).array().square();
    const double mean = samples.weights.size() != 0
                            ? (squares * samples.weights.transpose().array()).sum() / samples.weights.sum()
                            : squares.mean();
    sum += scale[o] * mean;
    ++varying;
  }
  return varying > 0 ? sum / varying : 0;
}

}  // namespace surefoot
