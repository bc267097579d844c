// Definitions of surefoot/diagnose/recording.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace surefoot {

SUREFOOT_ONCE Recording part_of(const Recording& whole, Eigen::Index from, Eigen::Index to,
                                const Eigen::VectorXd& initial, const Eigen::VectorXd& scale) {
  Recording part;
  part.name = whole.name + "[" + std::to_string(from) + ":" + std::to_string(to) + "]";
  part.constants = whole.constants;
  const auto columns = [&](const Eigen::MatrixXd& all) {
    Eigen::MatrixXd some(all.rows(), to - from);
    std::copy_n(all.data() + from * all.rows(), some.size(), some.data());
    return some;
  };
  part.time.resize(to - from);
  std::copy_n(whole.time.data() + from, part.time.size(), part.time.data());
  part.inputs = columns(whole.inputs);
  part.outputs = columns(whole.outputs);
  part.initial = from == 0 ? whole.initial : initial;
  part.initial_scale = from == 0 ? whole.initial_scale : scale;
  return part;
}

}  // namespace surefoot
