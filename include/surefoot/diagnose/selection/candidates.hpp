// Candidates: every effect at every place of a simulator that it fits.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "surefoot/diagnose/estimation/hypothesis.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"

namespace surefoot::diagnosis {

/// Inputs and signals (after the inputs) that are worth an effect: they change, and are no mere multiple of one before
/// (a cosine beyond `collinear`, see SelectionCriteria).
std::vector<bool> distinct_inputs(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                  const std::vector<std::size_t>& recordings,
                                  const std::vector<SimulatedRun>& trajectories,
                                  double collinear = SelectionCriteria{}.collinear);

/// By input and signal (after the inputs): which values it takes in any of the recordings.
struct InputValues {
  std::vector<bool> both_signs;    // values above 0 at times, and below 0 at others
  std::vector<bool> small_values;  // other than 0, and less than half of the largest
};

InputValues input_values(const BoundSimulator& bound, const Hypothesis& hypothesis,
                         const std::vector<std::size_t>& recordings, const std::vector<SimulatedRun>& trajectories);

/// Inputs that are 0 in the first row of every recording, and signals (after the inputs) if all inputs are: it is the
/// same whether they were as in that row before, or 0.
std::vector<bool> zero_at_first(const BoundSimulator& bound, const std::vector<std::size_t>& recordings);

/// Whether an effect on a velocity, or on another state, fits this state.
bool fits_velocity(const BoundSimulator& bound, const Effect& effect, std::size_t state);
bool fits_state(const BoundSimulator& bound, const Effect& effect, std::size_t state);

/// Every (effect, place) that fits the simulator; `distinct` as above.
std::vector<AttachedEffect> attachments(const BoundSimulator& bound, const std::vector<Effect>& effects,
                                        const std::vector<bool>& distinct);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/candidates.ipp"
#endif
