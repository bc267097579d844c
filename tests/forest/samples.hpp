// Functions to learn, and samples of them.
#pragma once

#include <cmath>
#include <cstdint>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/forest/dataset.hpp"

namespace surefoot::toy {

/// Smooth in some inputs, a cliff in one, the last without influence.
struct Cliff {
  static constexpr int inputs = 5, outputs = 1;
  Vec<1> operator()(const Vec<5>& x) const {
    return Vec<1>(std::sin(3 * x[0]) + x[1] * x[2] + (x[3] > 0.2 ? 2.0 : 0.0));
  }
};

/// Two clipped linear laws, like those of a bounded controller.
struct ClippedLaws {
  static constexpr int inputs = 4, outputs = 2;
  Vec<2> operator()(const Vec<4>& x) const {
    return Vec<2>(3 * x[0] - 2 * x[1], 2 * x[2] + x[3] + (x[0] > 0 ? 0.5 : -0.5)).cwiseMax(-1).cwiseMin(1);
  }
};

/// `count` samples of a function over [-1, 1]^inputs, with normal noise of the given size on the outputs.
template <class Function>
Dataset<Function::inputs, Function::outputs> sample(const Function& function, Eigen::Index count, std::uint64_t seed,
                                                    double noise = 0) {
  Rng rng(seed);
  Dataset<Function::inputs, Function::outputs> samples;
  samples.inputs.resize(Function::inputs, count);
  samples.outputs.resize(Function::outputs, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (int k = 0; k < Function::inputs; ++k) samples.inputs(k, i) = static_cast<float>(rng.uniform(-1, 1));
    samples.outputs.col(i) = function(samples.inputs.col(i).template cast<double>());
    for (int o = 0; o < Function::outputs; ++o) samples.outputs(o, i) += noise * rng.normal();
  }
  return samples;
}

/// Share of the outputs' variance that the forest explains: 1 is perfect, 0 is no better than their mean.
template <class Forest, int Inputs, int Outputs>
double explained(const Forest& forest, const Dataset<Inputs, Outputs>& samples) {
  Eigen::Matrix<double, Outputs, Eigen::Dynamic> predicted;
  forest.predict(samples.inputs, predicted);
  const Vec<Outputs> mean = samples.outputs.rowwise().mean();
  return 1 - (predicted - samples.outputs).squaredNorm() / (samples.outputs.colwise() - mean).squaredNorm();
}

}  // namespace surefoot::toy
