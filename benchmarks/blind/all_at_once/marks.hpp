// Every candidate effect as columns of a linear problem: the change of the residuals that each of its strengths causes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "prepare.hpp"

namespace all_at_once {

/// One unknown of the linear problem: the multiple of a strength's starting value; of the whole change between 0 and 1
/// for an effect without a strength.
struct Unknown {
  std::size_t candidate = 0;
  int parameter = -1;        // of the effect; -1: it has no strength
  double low = 0, high = 1;  // multiples of the start
};

/// residuals + jacobian * (parameters and initial states) + columns * unknowns, to be made small. Rows are those of the
/// recordings one after the other, cut off at the robust limit.
struct LinearProblem {
  std::vector<surefoot::AttachedEffect> candidates;
  std::vector<Eigen::VectorXd> starts;  // by candidate: the parameters around which it was linearised
  std::vector<Unknown> unknowns;
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian, columns;
  std::vector<Eigen::Index> begin;  // first row of each recording, then the number of rows
};

/// Linearises the candidates about the calibrated simulator. Of several starting values of an effect that is taken
/// which by itself explains most. Cost: two simulations of all training recordings per candidate and strength, one more
/// for each further start.
LinearProblem linearise(const Prepared& prepared, const std::vector<surefoot::AttachedEffect>& candidates,
                        const surefoot::diagnosis::Parallel& parallel);

}  // namespace all_at_once
