// Probability that none of the structures that were fitted is all of what is missing.
#pragma once

#include <Eigen/Core>

#include "surefoot/diagnose/selection/search.hpp"

namespace surefoot::diagnosis {

/// Posterior of a further, unknown effect beside the choice: it would leave no more than what a verdict takes for the
/// `noise` of each output [in the output's unit], and costs as much prior probability as an effect of the library. 0
/// where the noise of an output is not known (not above 0).
double probability_of_none(const Selection& selection, const Eigen::VectorXd& noise, const SearchProblem& problem);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/none_of_these.ipp"
#endif
