// Definitions of surefoot/forest/leaf.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/positive_definite.hpp"
#include "surefoot/forest/leaf.hpp"

namespace surefoot {

SUREFOOT_INLINE void ConstantLeaf::fit(const LeafSamples& samples, const LeafOptions&, std::span<float> parameters) {
  for (int o = 0; o < samples.outputs(); ++o) {
    double sum = 0;
    double weight = 0;
    for (std::size_t i = 0; i < samples.count(); ++i) {
      sum += samples.weight(i) * static_cast<double>(samples.output(i)[o]);
      weight += samples.weight(i);
    }
    parameters[static_cast<std::size_t>(o)] = static_cast<float>(sum / weight);
  }
}

SUREFOOT_ONCE std::string ConstantLeaf::c_code(int /*inputs*/, int outputs) {
  return "for (o = 0; o < " + std::to_string(outputs) + "; ++o) out[o] += (double)number(p + o);";
}

namespace detail {

/// Mean of the inputs and outputs of a leaf, and their second moments about it: moments[k * width + j] of input k with
/// column j.
struct LeafMoments {
  std::vector<double> mean, moments;

  explicit LeafMoments(const LeafSamples& samples) {
    const auto inputs = static_cast<std::size_t>(samples.inputs());
    const std::size_t width = inputs + static_cast<std::size_t>(samples.outputs());
    mean.resize(width);
    moments.resize(width * inputs);
    double weight = 0;
    for (std::size_t i = 0; i < samples.count(); ++i) {
      const float* row = samples.input(i);
      for (std::size_t j = 0; j < width; ++j) mean[j] += samples.weight(i) * static_cast<double>(row[j]);
      weight += samples.weight(i);
    }
    for (double& value : mean) value /= weight;
    std::vector<double> offset(width);
    std::vector<double> weighted(width);
    for (std::size_t i = 0; i < samples.count(); ++i) {
      const float* row = samples.input(i);
      for (std::size_t j = 0; j < width; ++j) {
        offset[j] = static_cast<double>(row[j]) - mean[j];
        weighted[j] = samples.weight(i) * offset[j];
      }
      for (std::size_t k = 0; k < inputs; ++k) {
        double* into = moments.data() + k * width;
        for (std::size_t j = 0; j < width; ++j) into[j] += offset[k] * weighted[j];
      }
    }
  }
};

/// Slopes of each output by ridge regression, output after output.
inline std::vector<double> ridge_slopes(const LeafMoments& about_mean, std::size_t inputs, std::size_t outputs,
                                        double enlarge) {
  const std::size_t width = inputs + outputs;
  std::vector<double> normal(inputs * inputs);
  for (std::size_t k = 0; k < inputs; ++k) {
    std::copy_n(about_mean.moments.data() + k * width, inputs, normal.data() + k * inputs);
    // To enlarge the diagonal by a factor is to add a constant to it if all inputs have unit spread.
    double& diagonal = normal[k * inputs + k];
    diagonal *= enlarge;
    if (!(diagonal > 0)) diagonal = 1;
  }
  std::vector<double> slopes(inputs * outputs);
  for (std::size_t o = 0; o < outputs; ++o) {
    for (std::size_t k = 0; k < inputs; ++k) slopes[o * inputs + k] = about_mean.moments[k * width + inputs + o];
  }
  solve_positive_definite(normal, inputs, slopes, outputs);
  return slopes;
}

}  // namespace detail

SUREFOOT_INLINE void LinearLeaf::fit(const LeafSamples& samples, const LeafOptions& options,
                                     std::span<float> parameters) {
  const int inputs = samples.inputs();
  const int outputs = samples.outputs();
  const auto width = static_cast<std::size_t>(inputs);
  const detail::LeafMoments about_mean(samples);
  const std::vector<double>& mean = about_mean.mean;
  const double enlarge = 1 + std::max(options.ridge, least_ridge) / static_cast<double>(samples.count());
  const std::vector<double> slopes =
      detail::ridge_slopes(about_mean, width, static_cast<std::size_t>(outputs), enlarge);
  for (int o = 0; o < outputs; ++o) {
    const auto output = static_cast<std::size_t>(o);
    float* p = parameters.data() + static_cast<std::ptrdiff_t>(o) * (inputs + 3);
    float low = samples.output(0)[o];
    float high = low;
    for (std::size_t i = 1; i < samples.count(); ++i) {
      low = std::min(low, samples.output(i)[o]);
      high = std::max(high, samples.output(i)[o]);
    }
    for (std::size_t k = 0; k < width; ++k) p[k] = static_cast<float>(slopes[output * width + k]);
    double constant = mean[width + output];
    for (std::size_t k = 0; k < width; ++k) constant -= static_cast<double>(p[k]) * mean[k];
    p[inputs] = static_cast<float>(constant);
    const bool usable = std::all_of(p, p + inputs + 1, [](float v) { return std::isfinite(v); });
    if (!usable) {
      std::fill(p, p + inputs, 0.0F);
      p[inputs] = static_cast<float>(mean[width + output]);
    }
    p[inputs + 1] = options.clamp ? low : std::numeric_limits<float>::lowest();
    p[inputs + 2] = options.clamp ? high : std::numeric_limits<float>::max();
  }
}

SUREFOOT_ONCE std::string LinearLeaf::c_code(int inputs, int outputs) {
  const std::string n = std::to_string(inputs);
  const auto at = [&](int i) { return "(double)number(p + " + std::to_string(inputs + i) + ")"; };
  return "for (o = 0; o < " + std::to_string(outputs) + "; ++o, p += " + std::to_string(inputs + 3) + ") {\n" +
         "  double y = " + at(0) + ";\n" + "  for (k = 0; k < " + n +
         "; ++k) y += (double)number(p + k) * (double)x[k];\n" + "  if (y < " + at(1) + ") y = " + at(1) + ";\n" +
         "  if (y > " + at(2) + ") y = " + at(2) + ";\n" + "  out[o] += y;\n" + "}";
}

}  // namespace surefoot
