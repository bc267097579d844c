// Errors that noise alone leaves of simulations that follow the readings. Their states take over some of the noise that
// they are drawn to, so that errors are larger than the noise, and related from row to row, though nothing is missing:
// they are those of an observer that is not the best one (L. Ljung, "System Identification: Theory for the User", 2nd
// ed., 1999, section 4.3).
#pragma once

#include <cstddef>
#include <vector>

#include "surefoot/diagnose/estimation/noise_regime.hpp"

namespace surefoot::diagnosis {

/// Of each output; empty where simulations follow nothing, or run away.
struct PredictionNoise {
  std::vector<double> amplification;  // root mean square of the errors over that of the noise; at least 1
  std::vector<double> structure;      // mean square of what is related beyond the memory of noise [output unit^2]
};

/// The amplification of an output; 1 where simulations follow nothing.
inline double amplification_of(const PredictionNoise& noise, std::size_t output) {
  return noise.amplification.empty() ? 1 : noise.amplification[output];
}

/// By a trial: a machine that moves as the hypothesis is simulated now, read with noise of the size that was
/// stated, or that the fast part of what is left shows, as is how much of it the next row keeps. Cost: two simulations
/// of these recordings, and a test of each output.
PredictionNoise prediction_noise(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                 const std::vector<std::size_t>& recordings, const Parallel& parallel);

/// Whether recordings are far nearer to simulations of them than the trial says that noise alone leaves: then it was of
/// a motion that is no such machine's, and says nothing.
bool is_refuted(const PredictionNoise& noise, const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                const std::vector<SimulatedRun>& runs);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/prediction_noise.ipp"
#endif
