// Machines that are unstable by themselves, held by a controller that is not part of the model: a balancing robot of
// which the motor voltages were recorded; and chaotic ones, as a double pendulum that swings widely. What is off by the
// noise at the beginning is off by everything before the end, so that no whole recording can be simulated. Simulations
// of such machines follow the readings with a constant gain, and their errors are those of predictions over as long as
// the machine forgets nothing (L. Ljung, "System Identification: Theory for the User", 2nd ed., 1999, section 3.3:
// prediction errors of a model with an observer).
#pragma once

#include "surefoot/diagnose/estimation/hypothesis.hpp"

namespace surefoot::diagnosis {

/// How fast small differences of states grow along the measured motion: the largest Lyapunov exponent of the median
/// recording [1/s], over all of its length; negative where they shrink. States that are measured as outputs are kept
/// near their readings meanwhile. Cost: a simulation of each recording for each state.
double growth_rate(const BoundSimulator& bound, const Hypothesis& hypothesis, const Parallel& parallel);

/// Integration::follow that a machine needs: 0 unless differences grow a thousandfold over the median recording, and
/// for maps and where no state is measured.
double needed_follow(const BoundSimulator& bound, const Hypothesis& hypothesis, const Parallel& parallel);

/// Whether simulations of most recordings, which follow nothing, move about as much as the machine did. Where
/// differences grow all the same, the motion is chaotic: no controller holds the machine.
bool moves_as_measured(const BoundSimulator& bound, const Hypothesis& hypothesis);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/instability.ipp"
#endif
