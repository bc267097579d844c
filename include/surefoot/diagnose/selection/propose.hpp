// Proposes effects: every effect at every place where it may attach, ranked by how much of the residuals the change of
// the simulation that it causes would explain, apart from what the model's own parameters could do.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/starting_values.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"

namespace surefoot::diagnosis {

/// An effect that is worth a fit, with the numbers to start it from.
struct Proposal {
  AttachedEffect effect;
  Eigen::VectorXd start;
  double gain = 0;                           // share of the squared residuals it would explain
  double distinct = 0;                       // share of its mark that the parameters cannot imitate
  Eigen::VectorXd tried;                     // the numbers it was screened with
  std::vector<Eigen::VectorXd> more_starts;  // worse ones; for effects without a strength the order means little
  double visible = 0;  // multiple of those that would take away a twentieth of the residuals' squares
};

/// Ranks candidates, best first. `base` is fitted; only `problem.recordings` are simulated, once per candidate, start
/// and strength. Residuals beyond the robust limit are cut off there.
std::vector<Proposal> propose(const BoundSimulator& bound, const Hypothesis& base, const FitProblem& problem,
                              const std::vector<AttachedEffect>& candidates, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/propose.ipp"
#endif
