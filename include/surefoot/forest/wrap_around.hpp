// Inputs that wrap around, such as angles: a tree must cut them open somewhere (at +-pi), and its leaves there see the
// samples of one side only. Copies of the samples near the cut, moved by one turn to beyond the other end, let leaves
// reach across. Training and prediction stay as they are.
//
// Measured on periodic functions of 2 and 6 inputs with 200 to 2,000 leaves per tree, as many with as without: at the
// seam (the last tenth of a turn) 10 to 45 % less squared error, overall from 20 % less to 2 % more. With 30 leaves or
// a large margin it loses: the copies take leaves. The other way is to give cosine and sine as two inputs: better with
// few or linear leaves, for one input more and their computation per prediction.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "surefoot/core/error.hpp"
#include "surefoot/forest/dataset.hpp"

namespace surefoot {

struct WrapOptions {
  double low = -std::numbers::pi;        // the input lies in [low, low + period]
  double period = 2 * std::numbers::pi;  // [unit of the input]
  double margin = 0.05;                  // how far the copies reach beyond either end [periods], above 0, at most 0.5
};

/// The samples and, behind them, the copies: about 2 * margin as many again. For several inputs that wrap around, call
/// it once for each: copies of copies fill the corners. Throws a ForestError if the input does not exist, or a sample
/// lies outside of the range.
template <int Inputs, int Outputs>
Dataset<Inputs, Outputs> wrap_around(const Dataset<Inputs, Outputs>& samples, int input,
                                     const WrapOptions& options = {}) {
  check(samples);
  auto fail = [](const std::string& what) { throw ForestError("wrap_around: " + what); };
  if (input < 0 || input >= samples.inputs.rows()) {
    fail("input must be from 0 to " + std::to_string(samples.inputs.rows() - 1) + ", got " + std::to_string(input));
  }
  if (!std::isfinite(options.low)) fail("low must be finite");
  if (!(options.period > 0) || !std::isfinite(options.period)) fail("period must be positive and finite");
  if (!(options.margin > 0 && options.margin <= 0.5)) fail("margin must be above 0 and at most 0.5");
  const double high = options.low + options.period;
  const double reach = options.margin * options.period;
  struct Copy {
    Eigen::Index sample;
    double value;
  };
  std::vector<Copy> copies;
  const Eigen::Index count = samples.inputs.cols();
  for (Eigen::Index i = 0; i < count; ++i) {
    const float value = samples.inputs(input, i);
    if (value < static_cast<float>(options.low) || value > static_cast<float>(high)) {
      fail("input " + std::to_string(input) + " of sample " + std::to_string(i) + " is outside of [" +
           std::to_string(options.low) + ", " + std::to_string(high) + "]: " + std::to_string(value));
    }
    const auto x = static_cast<double>(value);
    if (x < options.low + reach) copies.push_back({i, x + options.period});
    if (x > high - reach) copies.push_back({i, x - options.period});
  }
  Dataset<Inputs, Outputs> wrapped = samples;
  const Eigen::Index total = count + static_cast<Eigen::Index>(copies.size());
  wrapped.inputs.conservativeResize(Eigen::NoChange, total);
  wrapped.outputs.conservativeResize(Eigen::NoChange, total);
  if (samples.weights.size() != 0) wrapped.weights.conservativeResize(total);
  for (Eigen::Index i = count; i < total; ++i) {
    const Copy& copy = copies[static_cast<std::size_t>(i - count)];
    wrapped.inputs.col(i) = samples.inputs.col(copy.sample);
    wrapped.inputs(input, i) = static_cast<float>(copy.value);
    wrapped.outputs.col(i) = samples.outputs.col(copy.sample);
    if (samples.weights.size() != 0) wrapped.weights[i] = samples.weights[copy.sample];
  }
  return wrapped;
}

}  // namespace surefoot
