// Starting values for the fit of an effect: its own, in the units of the model, or those that readings suggest.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "surefoot/diagnose/estimation/hypothesis.hpp"

namespace surefoot::diagnosis {

/// Largest absolute value of what an effect is attached to: of its position if it is a velocity.
double peak_at(const BoundSimulator& bound, const AttachedEffect& attached);

/// The output that reads what an effect is attached to (of a velocity: what it is the speed of), or -1.
int output_watching(const BoundSimulator& bound, const AttachedEffect& attached);

/// What one output read, and what was simulated without the effect that is to be started.
struct Observed {
  std::vector<double> readings, simulated;
};

/// By output.
std::vector<Observed> observe(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                              const std::vector<SimulatedRun>& runs);

/// Every combination of the starting values, in units of the model.
std::vector<Eigen::VectorXd> starting_values(const BoundSimulator& bound, const AttachedEffect& attached,
                                             const std::vector<Observed>& observed);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/starting_values.ipp"
#endif
