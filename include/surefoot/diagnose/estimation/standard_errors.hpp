// Standard errors of fitted parameters.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "surefoot/diagnose/estimation/fit.hpp"

namespace surefoot::diagnosis {

/// Two-sided 95 % quantile of the standard normal distribution.
inline constexpr double normal_quantile_95 = 1.96;

/// They hold for residuals that are not independent: the covariance of the gradient is estimated over blocks of the
/// recordings (sandwich; Huber 1967, White 1980).
struct StandardErrors {
  std::vector<Variable> variables;
  Eigen::VectorXd deviation;    // in units of the model
  Eigen::MatrixXd correlation;  // of the searched coordinates
};

/// What recordings do not determine has the width of its prior (prior_width), also where a simulation is not quite
/// smooth: differences along such directions are as wide as what is not known. Cost: a central Jacobian (see
/// FitFunctions), some ten simulations of all recordings, and the cube of the number of variables.
StandardErrors standard_errors(const BoundSimulator& bound, const Hypothesis& hypothesis, const FitProblem& problem,
                               const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/standard_errors.ipp"
#endif
