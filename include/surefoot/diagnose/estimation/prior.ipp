// Definitions of surefoot/diagnose/estimation/prior.hpp.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/prior.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE PriorRows prior_rows(const std::vector<Variable>& variables, const Eigen::VectorXd& parameters) {
  constexpr double deviations = 6;  // from bound to bound
  Eigen::Index count = 0;
  for (const Variable& one : variables) {
    if (parameters.size() > 0 && one.kind == Variable::Kind::parameter) ++count;
  }
  PriorRows prior{Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const Variable& one = variables[static_cast<std::size_t>(k)];
    prior.mean[k] = to_search(one, parameters[static_cast<Eigen::Index>(one.index)]);
    prior.slope[k] = deviations / (to_search(one, one.high) - to_search(one, one.low));
  }
  return prior;
}

}  // namespace surefoot::diagnosis
