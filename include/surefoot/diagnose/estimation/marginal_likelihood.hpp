// Parts of the marginal likelihood of a hypothesis: how far its fit is off in each recording, how many of these errors
// are independent, and what its parameters cost.
//
// The cost is the Occam factor of Laplace's approximation (MacKay, "Bayesian interpolation", Neural Computation 4,
// 1992): the share of the prior volume of all parameters that is left by the recordings, with normal priors as wide as
// the bounds. A direction that nothing determines costs nothing. Sizes of effects have a prior that is the same for
// every order of magnitude (Jeffreys, "Theory of Probability", 1939, III.3.1), so that two effects which are the same
// in other words, as a bias of the only angle sensor and a turned direction of gravity, are equally probable.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {

/// Errors by recording (row) and output (column).
struct ErrorSquares {
  Eigen::MatrixXd mean_squares;  // in units of the square of the scale they were measured with
  Eigen::MatrixXd counts;        // of measured cells
  Eigen::VectorXd memory;        // by output: integrated autocorrelation time of the errors [rows], at least 1
  Eigen::VectorXd least = {};    // by output: differences of the mean square that mean nothing; empty: 0
  Eigen::VectorXd least_elsewhere = {};  // the same where no form is mended: less beside noise alone; empty: as `least`

  bool empty() const { return mean_squares.size() == 0; }
  /// Root of the mean over all cells.
  double rms() const;
};

/// Integrated autocorrelation time of some series [rows]: of n values only n / time tell something new. The larger of
/// 1 + 2 * sum of correlations until these turn negative (initial positive sequence, Geyer 1992), for slow errors, and
/// 1 + 2 * sum of their squares (Bartlett 1946), for oscillating ones. At least 1. Cost: rows * lags.
double autocorrelation_time(const std::vector<Eigen::VectorXd>& series);

/// Errors of a hypothesis, in units of `scale`.
ErrorSquares error_squares(const BoundSimulator& bound, const Hypothesis& hypothesis,
                           const std::vector<std::size_t>& recordings, const Integration& integration,
                           const Weighting& scale, const Parallel& parallel);

/// Width of the prior of a parameter with this value, in searched coordinates: half that of its bounds; for a size of
/// an effect that may be zero, where its prior density is even in log(size), one that gives the same density here.
double prior_width(const Variable& variable, double value);

/// Log of the Occam factor of a fit [nat], at most 0: -1/2 log det(1 + W I W), where I is the information of
/// independent errors on the parameters, initial states eliminated, and W the widths of the priors, in searched
/// coordinates. `least_variance`: of the weighted errors; smaller ones tell no more. Cost: one Jacobian (see
/// FitFunctions).
double log_occam_factor(const BoundSimulator& bound, const Hypothesis& fitted, const FitProblem& problem,
                        double least_variance, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/marginal_likelihood.ipp"
#endif
