// The fraction of variance unexplained: how wrong a forest is on given samples.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/forest.hpp"

namespace surefoot {

namespace detail {

/// Throws a ForestError that starts with `who` unless a forest of that shape can be compared with the samples.
void check_fit(const TreesShape& forest, bool empty, const DatasetView& samples, const char* who);

template <int Inputs, int Outputs, LeafModel Leaf>
void check_fit(const Forest<Inputs, Outputs, Leaf>& forest, const Dataset<Inputs, Outputs>& samples, const char* who) {
  if (!forest.empty()) check(samples);
  check_fit(forest.raw(), forest.empty(), view_of(samples), who);
}

}  // namespace detail

/// The fraction of the outputs' variance that the forest does not explain (1 - R2): 0 is perfect, 1 no better than
/// their mean. Several outputs: the mean of their fractions; an output that does not vary in the samples is left out.
/// Throws ForestError if shapes differ or the forest is empty. One batch prediction.
template <int Inputs, int Outputs, LeafModel Leaf>
double fraction_of_variance_unexplained(const Forest<Inputs, Outputs, Leaf>& forest,
                                        const Dataset<Inputs, Outputs>& samples) {
  detail::check_fit(forest, samples, "fraction_of_variance_unexplained");
  typename Forest<Inputs, Outputs, Leaf>::BatchOutput predicted;
  forest.predict(samples.inputs, predicted);
  const std::vector<double> scale = detail::inverse_variances(detail::view_of(samples));
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

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/fraction_of_variance_unexplained.ipp"
#endif
