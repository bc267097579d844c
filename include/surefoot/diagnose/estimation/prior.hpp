// Normal prior of a model's parameters: near the values that the model came with, its bounds three standard deviations
// to either side of the middle. Where few rows are fitted, what they do not tell stays where it was, instead of running
// to a bound (maximum a posteriori estimate).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "surefoot/diagnose/estimation/hypothesis.hpp"

namespace surefoot::diagnosis {

/// One row of residuals by parameter: how many standard deviations it is off, slope * (z - mean).
struct PriorRows {
  Eigen::VectorXd mean, slope;  // in the searched coordinates of the parameters, which are the first variables
};

/// For these variables; no rows where `parameters` is empty.
PriorRows prior_rows(const std::vector<Variable>& variables, const Eigen::VectorXd& parameters);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/prior.ipp"
#endif
