// A leaf model of one's own: predicts the middle between the smallest and the largest sample of the leaf.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"

struct MiddleLeaf {
  static constexpr std::uint32_t tag = 1001;  // names it in files; from 1000 on they belong to users
  static constexpr std::size_t parameters(int /*inputs*/, int outputs) { return static_cast<std::size_t>(outputs); }

  static void fit(const surefoot::LeafSamples& samples, const surefoot::LeafOptions&, std::span<float> parameters) {
    for (int o = 0; o < samples.outputs(); ++o) {
      float low = samples.output(0)[o], high = low;
      for (std::size_t i = 1; i < samples.count(); ++i) {
        low = std::min(low, samples.output(i)[o]);
        high = std::max(high, samples.output(i)[o]);
      }
      parameters[static_cast<std::size_t>(o)] = (low + high) / 2;
    }
  }
  static void add(const float* parameters, const float* /*x*/, int /*inputs*/, int outputs, double* sum) {
    for (int o = 0; o < outputs; ++o) sum[o] += static_cast<double>(parameters[o]);
  }
};
static_assert(surefoot::LeafModel<MiddleLeaf>);

using TorqueForest = surefoot::Forest<2, 1, MiddleLeaf>;  // angle [rad], speed [rad/s] -> torque [N m]
