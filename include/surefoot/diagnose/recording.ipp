// Definitions of surefoot/diagnose/recording.hpp.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace surefoot {

SUREFOOT_INLINE Recording part_of(const Recording& whole, Eigen::Index from, Eigen::Index to,
                                  const Eigen::VectorXd& initial, const Eigen::VectorXd& scale) {
  Recording part;
  part.name = whole.name + "[" + std::to_string(from) + ":" + std::to_string(to) + "]";
  part.constants = whole.constants;
  part.time = whole.time.segment(from, to - from);
  part.inputs = whole.inputs.middleCols(from, to - from);
  part.outputs = whole.outputs.middleCols(from, to - from);
  part.initial = from == 0 ? whole.initial : initial;
  part.initial_scale = from == 0 ? whole.initial_scale : scale;
  return part;
}

}  // namespace surefoot
