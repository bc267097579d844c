// Which candidates survive an L1 penalty that held-out recordings choose.
#pragma once

#include <cstddef>
#include <vector>

#include "signatures.hpp"

namespace all_at_once {

/// An effect whose coefficients are not all zero.
struct Survivor {
  std::size_t candidate = 0;
  Eigen::VectorXd values;  // of its parameters, in units of the model
  double energy = 0;       // squared change of the residuals that it makes, apart from what parameters could
};

struct Choice {
  std::vector<Survivor> survivors;  // the one with the largest energy first
  double penalty = 0;               // share of the least penalty at which nothing survives
};

/// `folds` hold places among the training recordings. Of all penalties whose held-out loss is within one standard error
/// of the least it takes the largest. The standard error is that of the difference, in pairs over blocks of recordings.
Choice choose(const LinearProblem& problem, const std::vector<std::vector<std::size_t>>& folds, double robust);

}  // namespace all_at_once
