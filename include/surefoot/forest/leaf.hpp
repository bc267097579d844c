// Leaf models: what a tree predicts inside one leaf. ConstantLeaf (piecewise constant, PWC) and LinearLeaf (piecewise
// linear, PWL); users can add their own.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

namespace surefoot {

/// The samples of one leaf during training.
class LeafSamples {
 public:
  /// `records` holds `count` samples of `stride` floats each: inputs, then outputs, then (if weighted) the weight.
  LeafSamples(const float* records, std::size_t count, std::size_t stride, int inputs, int outputs, bool weighted)
      : records_(records), count_(count), stride_(stride), inputs_(inputs), outputs_(outputs), weighted_(weighted) {}

  std::size_t count() const { return count_; }
  int inputs() const { return inputs_; }
  int outputs() const { return outputs_; }
  const float* input(std::size_t sample) const { return records_ + sample * stride_; }
  const float* output(std::size_t sample) const { return input(sample) + inputs_; }
  double weight(std::size_t sample) const {
    return weighted_ ? static_cast<double>(input(sample)[inputs_ + outputs_]) : 1.0;
  }

 private:
  const float* records_;
  std::size_t count_;
  std::size_t stride_;
  int inputs_;
  int outputs_;
  bool weighted_;
};

struct LeafOptions {
  double ridge = 1;   // regularises the slopes as if by so many samples without slope [samples]; linear leaves
  bool clamp = true;  // never predict outside the outputs of the leaf's own samples; linear leaves
};

/// A leaf model is a stateless struct that turns the samples of a leaf into a fixed number of floats, and an input and
/// those floats into outputs. The smallest conforming struct (the median would do as well):
///
///   struct FirstSampleLeaf {
///     static constexpr std::uint32_t tag = 1000;   // names the model in files; 0..999 belong to this library
///     static constexpr std::size_t parameters(int inputs, int outputs) { return std::size_t(outputs); }
///     static void fit(const surefoot::LeafSamples& samples, const surefoot::LeafOptions&, std::span<float> parameters)
///     {
///       std::copy_n(samples.output(0), parameters.size(), parameters.begin());
///     }
///     static void add(const float* parameters, const float* x, int inputs, int outputs, double* sum) {
///       for (int o = 0; o < outputs; ++o) sum[o] += parameters[o];
///     }
///   };
///
/// `fit` gets at least one sample and must leave finite numbers. `add` adds the outputs at x to `sum`.
/// Optional: `static std::string c_code(int inputs, int outputs)`, what `add` does as C99 for export_c: statements that
/// read the leaf's numbers as number(p), number(p + 1), ... and the input as x[...], and add to out[...]. They may
/// change `p`, and use the uint32_t variables `o` and `k`.
template <class L>
concept LeafModel = requires(const LeafSamples& samples, const LeafOptions& options, std::span<float> parameters,
                             const float* x, double* sum) {
  { L::tag } -> std::convertible_to<std::uint32_t>;
  { L::parameters(1, 1) } -> std::same_as<std::size_t>;
  L::fit(samples, options, parameters);
  L::add(x, x, 1, 1, sum);
};

/// The weighted mean of the samples. One float per output.
struct ConstantLeaf {
  static constexpr std::uint32_t tag = 1;

  static constexpr std::size_t parameters(int /*inputs*/, int outputs) { return static_cast<std::size_t>(outputs); }

  static void fit(const LeafSamples& samples, const LeafOptions&, std::span<float> parameters) {
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

  static void add(const float* parameters, const float* /*x*/, int /*inputs*/, int outputs, double* sum) {
    for (int o = 0; o < outputs; ++o) sum[o] += static_cast<double>(parameters[o]);
  }

  static std::string c_code(int /*inputs*/, int outputs) {
    return "for (o = 0; o < " + std::to_string(outputs) + "; ++o) out[o] += (double)number(p + o);";
  }
};

/// An affine function per output: slopes, offset, and the range its value is clamped to; inputs + 3 floats per output.
/// Ridge regression (Hoerl & Kennard 1970) on inputs in units of their spread in the leaf: with n samples a slope
/// shrinks by about n / (n + ridge). An input that does not vary in the leaf gets slope 0. Fit: O(count inputs^2 +
/// inputs^3).
struct LinearLeaf {
  static constexpr std::uint32_t tag = 2;
  static constexpr bool linear = true;         // splits are scored by the residuals of affine fits
  static constexpr double least_ridge = 1e-6;  // keeps fits to dependent inputs or few samples solvable

  static constexpr std::size_t parameters(int inputs, int outputs) {
    return static_cast<std::size_t>(outputs) * (static_cast<std::size_t>(inputs) + 3);
  }

  static void fit(const LeafSamples& samples, const LeafOptions& options, std::span<float> parameters) {
    const int inputs = samples.inputs();
    const int outputs = samples.outputs();
    const auto row = [&](std::size_t i) {
      return Eigen::Map<const Eigen::VectorXf>(samples.input(i), inputs + outputs).cast<double>();
    };
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(inputs + outputs);
    double weight = 0;
    for (std::size_t i = 0; i < samples.count(); ++i) {
      mean += samples.weight(i) * row(i);
      weight += samples.weight(i);
    }
    mean /= weight;
    Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(inputs + outputs, inputs);  // about the mean
    Eigen::VectorXd offset(inputs + outputs);
    for (std::size_t i = 0; i < samples.count(); ++i) {
      offset = row(i) - mean;
      for (int k = 0; k < inputs; ++k) moments.col(k) += offset[k] * (samples.weight(i) * offset);
    }
    // To enlarge the diagonal by a factor is to add a constant to it if all inputs have unit spread.
    Eigen::MatrixXd normal = moments.topRows(inputs);
    normal.diagonal() *= 1 + std::max(options.ridge, least_ridge) / static_cast<double>(samples.count());
    for (int k = 0; k < inputs; ++k) {
      if (!(normal(k, k) > 0)) normal(k, k) = 1;
    }
    const Eigen::MatrixXd slopes = normal.llt().solve(moments.bottomRows(outputs).transpose());
    for (int o = 0; o < outputs; ++o) {
      float* p = parameters.data() + static_cast<std::ptrdiff_t>(o) * (inputs + 3);
      float low = samples.output(0)[o];
      float high = low;
      for (std::size_t i = 1; i < samples.count(); ++i) {
        low = std::min(low, samples.output(i)[o]);
        high = std::max(high, samples.output(i)[o]);
      }
      for (int k = 0; k < inputs; ++k) p[k] = static_cast<float>(slopes(k, o));
      double constant = mean[inputs + o];
      for (int k = 0; k < inputs; ++k) constant -= static_cast<double>(p[k]) * mean[k];
      p[inputs] = static_cast<float>(constant);
      const bool usable = std::all_of(p, p + inputs + 1, [](float v) { return std::isfinite(v); });
      if (!usable) {
        std::fill(p, p + inputs, 0.0F);
        p[inputs] = static_cast<float>(mean[inputs + o]);
      }
      p[inputs + 1] = options.clamp ? low : std::numeric_limits<float>::lowest();
      p[inputs + 2] = options.clamp ? high : std::numeric_limits<float>::max();
    }
  }

  // A product of two floats is exact in double, so a fused multiply-add gives the same bits as none.
  static void add(const float* parameters, const float* x, int inputs, int outputs, double* sum) {
    for (int o = 0; o < outputs; ++o, parameters += inputs + 3) {
      double y = static_cast<double>(parameters[inputs]);
      for (int k = 0; k < inputs; ++k) y += static_cast<double>(parameters[k]) * static_cast<double>(x[k]);
      y = std::max(y, static_cast<double>(parameters[inputs + 1]));
      sum[o] += std::min(y, static_cast<double>(parameters[inputs + 2]));
    }
  }

  static std::string c_code(int inputs, int outputs) {
    const std::string n = std::to_string(inputs);
    const auto at = [&](int i) { return "(double)number(p + " + std::to_string(inputs + i) + ")"; };
    return "for (o = 0; o < " + std::to_string(outputs) + "; ++o, p += " + std::to_string(inputs + 3) + ") {\n" +
           "  double y = " + at(0) + ";\n" + "  for (k = 0; k < " + n +
           "; ++k) y += (double)number(p + k) * (double)x[k];\n" + "  if (y < " + at(1) + ") y = " + at(1) + ";\n" +
           "  if (y > " + at(2) + ") y = " + at(2) + ";\n" + "  out[o] += y;\n" + "}";
  }
};

}  // namespace surefoot
