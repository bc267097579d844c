// Samples of a function of three features, drawn evenly from [-1, 1] each.
#pragma once

#include <functional>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/forest/dataset.hpp"

namespace surefoot::toy {

inline Dataset<3, 1> sampled_values(const std::function<double(const Vec<3>&)>& value, int count) {
  Rng rng(1);
  Dataset<3, 1> data;
  data.inputs.resize(3, count);
  data.outputs.resize(1, count);
  for (int i = 0; i < count; ++i) {
    const Vec<3> x(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    data.inputs.col(i) = x.cast<float>();
    data.outputs(0, i) = value(x);
  }
  return data;
}

inline double quadratic(const Vec<3>& x) { return 1 + x[0] - 3 * x[1] * x[2] - 5 * x.squaredNorm(); }

}  // namespace surefoot::toy
