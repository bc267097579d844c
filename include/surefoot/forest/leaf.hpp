// Leaf models: what a tree predicts inside one leaf. ConstantLeaf (piecewise constant, PWC) and LinearLeaf (piecewise
// linear, PWL); users can add their own.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "surefoot/core/compiled.hpp"

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

  static void fit(const LeafSamples& samples, const LeafOptions& options, std::span<float> parameters);

  static void add(const float* parameters, const float* /*x*/, int /*inputs*/, int outputs, double* sum) {
    for (int o = 0; o < outputs; ++o) sum[o] += static_cast<double>(parameters[o]);
  }

  static std::string c_code(int inputs, int outputs);
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

  static void fit(const LeafSamples& samples, const LeafOptions& options, std::span<float> parameters);

  // A product of two floats is exact in double, so a fused multiply-add gives the same bits as none.
  static void add(const float* parameters, const float* x, int inputs, int outputs, double* sum) {
    for (int o = 0; o < outputs; ++o, parameters += inputs + 3) {
      double y = static_cast<double>(parameters[inputs]);
      for (int k = 0; k < inputs; ++k) y += static_cast<double>(parameters[k]) * static_cast<double>(x[k]);
      y = std::max(y, static_cast<double>(parameters[inputs + 1]));
      sum[o] += std::min(y, static_cast<double>(parameters[inputs + 2]));
    }
  }

  static std::string c_code(int inputs, int outputs);
};

namespace detail {

/// A leaf model as tree growing sees it: one copy of that for all leaf models.
struct LeafKind {
  bool linear = false;                                      // splits are scored by affine fits
  std::size_t (*parameters)(int inputs, int outputs) = {};  // floats per leaf
  void (*fit)(const LeafSamples&, const LeafOptions&, std::span<float>) = {};
  void (*add)(const float* parameters, const float* x, int inputs, int outputs, double* sum) = {};
};

template <LeafModel Leaf>
constexpr LeafKind leaf_kind() {
  return {requires {requires Leaf::linear;
}
, [](int inputs, int outputs) { return Leaf::parameters(inputs, outputs); },
    [](const LeafSamples& samples, const LeafOptions& options, std::span<float> parameters) {
      Leaf::fit(samples, options, parameters);
    },
    [](const float* parameters, const float* x, int inputs, int outputs, double* sum) {
      Leaf::add(parameters, x, inputs, outputs, sum);
    }
};  // namespace detail
}  // namespace surefoot

}  // namespace detail
}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/leaf.ipp"
#endif
