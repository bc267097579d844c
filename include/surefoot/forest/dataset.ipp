// Definitions of surefoot/forest/dataset.hpp.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/dataset.hpp"

namespace surefoot::detail {

/// Throws unless all numbers, `rows` per sample, are finite in single precision: trees keep them so.
template <class Number>
void check_finite(const Number* numbers, Eigen::Index rows, Eigen::Index count, const char* field) {
  bool finite = true;
  for (Eigen::Index i = 0; i < rows * count; ++i) {
    const auto number = static_cast<float>(numbers[i]);
    finite = finite & (number - number == 0.0F);
  }
  if (finite) return;
  for (Eigen::Index i = 0; i < rows * count; ++i) {
    if (!std::isfinite(static_cast<float>(numbers[i]))) {
      throw ForestError("Dataset: " + std::string(field) + " " + std::to_string(i % rows) + " of sample " +
                        std::to_string(i / rows) + " is not finite in single precision");
    }
  }
}

SUREFOOT_ONCE void check_samples(const DatasetView& samples, Eigen::Index outputs, Eigen::Index weights) {
  const Eigen::Index count = samples.count;
  const auto fail = [](const std::string& what) { throw ForestError("Dataset: " + what); };
  if (count == 0) fail("there are no samples (inputs has no columns)");
  if (samples.input_rows == 0 || samples.output_rows == 0) fail("needs at least one input row and one output row");
  if (outputs != count) {
    fail("inputs has " + std::to_string(count) + " columns but outputs has " + std::to_string(outputs));
  }
  if (weights != 0 && weights != count) {
    fail("weights must be empty or have one entry for each of the " + std::to_string(count) + " samples, got " +
         std::to_string(weights));
  }
  check_finite(samples.inputs, samples.input_rows, count, "input");
  check_finite(samples.outputs, samples.output_rows, count, "output");
  for (Eigen::Index i = 0; i < weights; ++i) {
    const auto weight = static_cast<float>(samples.weights[i]);
    if (!(weight > 0) || !std::isfinite(weight)) {
      fail("weight of sample " + std::to_string(i) + " must be positive and finite in single precision, got " +
           std::to_string(samples.weights[i]));
    }
  }
}

/// term(0) + ... + term(count - 1), in four running sums: the order in which Eigen adds with vectors of two.
template <class Term>
double sum_of(Eigen::Index count, const Term& term) {
  if (count < 2) return count == 0 ? 0.0 : term(0);
  std::array<double, 4> sums{term(0), term(1), 0, 0};
  if (count >= 4) {
    sums[2] = term(2);
    sums[3] = term(3);
    Eigen::Index i = 4;
    for (; i + 4 <= count; i += 4) {
      for (Eigen::Index lane = 0; lane < 4; ++lane) sums[static_cast<std::size_t>(lane)] += term(i + lane);
    }
    sums[0] += sums[2];
    sums[1] += sums[3];
    if (i + 2 <= count) {
      sums[0] += term(i);
      sums[1] += term(i + 1);
    }
  }
  const double sum = sums[0] + sums[1];
  return count % 2 == 0 ? sum : sum + term(count - 1);
}

SUREFOOT_ONCE std::vector<double> inverse_variances(const DatasetView& samples) {
  const auto weight = [&](Eigen::Index i) { return samples.weights == nullptr ? 1.0 : samples.weights[i]; };
  const double weights = sum_of(samples.count, weight);
  std::vector<double> inverse;
  for (Eigen::Index o = 0; o < samples.output_rows; ++o) {
    // About the first sample's, so that one that does not vary gives exactly 0.
    const double* output = samples.outputs + o;
    const auto offset = [&](Eigen::Index i) { return output[i * samples.output_rows] - *output; };
    const auto share = [&](Eigen::Index i) { return weight(i) / weights; };
    const double mean = sum_of(samples.count, [&](Eigen::Index i) { return share(i) * offset(i); });
    const double variance = sum_of(samples.count, [&](Eigen::Index i) {
      const double distance = offset(i) - mean;
      return share(i) * (distance * distance);
    });
    inverse.push_back(variance > 0 ? 1 / variance : 0.0);
  }
  return inverse;
}

}  // namespace surefoot::detail
