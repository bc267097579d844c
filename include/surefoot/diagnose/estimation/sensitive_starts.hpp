// Recordings in which differences smaller than the noise decide what comes later: a pendulum that falls over to one
// side or the other. No simulation from a start that is known as well as it was measured follows such a recording to
// its end, and the error of a fit has a valley for each way that it may go. A part of it that begins later, from where
// it was measured by then, has one (multiple shooting: H. G. Bock, "Recent advances in parameter identification
// techniques for ODE", 1983; J. P. L. Ribeiro et al., "On the smoothness of nonlinear system identification",
// Automatica 121, 2020).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/estimation/hypothesis.hpp"

namespace surefoot::diagnosis {

/// Rows from which on recording r must be a recording of its own: a start as well known as the readings near it tell
/// does not say what comes after that row. Empty for most recordings. `states` (state x row) are those of a simulation
/// close to the readings. Cost: 2 simulations for each measured state, over the recording at most as often as there are
/// pieces.
std::vector<std::size_t> sensitive_rows(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t r,
                                        const Eigen::MatrixXd& states);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/sensitive_starts.ipp"
#endif
