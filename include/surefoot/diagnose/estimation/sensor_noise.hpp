// Noise and resolution of sensors, from readings alone; and initial states that were read off a sensor.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/simulation/bound_simulator.hpp"

namespace surefoot::diagnosis {

/// Standard deviation of noise that differs from reading to reading, from third divided differences of readings (they
/// remove motion that is smooth over four of them, whatever rows were not read in between); noise that is correlated
/// from reading to reading is underestimated. 0 of less than a few readings.
double fast_noise(const BoundSimulator& bound, const std::vector<std::size_t>& recordings, Eigen::Index output);

/// Least step between readings of one output that differ, in the recordings; 0 if none do.
double resolution(const BoundSimulator& bound, const std::vector<std::size_t>& recordings, Eigen::Index output);

/// Standard deviation of the rounding of an output that reads in steps so coarse that readings repeat, which fast noise
/// does not show; 0 of any other.
double rounding_error(const BoundSimulator& bound, const std::vector<std::size_t>& recordings, Eigen::Index output);

/// Standard deviation of the noise of one output: as stated, or as far as it is fast.
inline double noise_of(const BoundSimulator& bound, const std::vector<std::size_t>& recordings, Eigen::Index output) {
  const double stated = bound.info.outputs[static_cast<std::size_t>(output)].noise;
  return stated > 0 ? stated : fast_noise(bound, recordings, output);
}

/// An initial state that was read off a sensor is known as well as that sensor reads: it is estimated, within its noise
/// and the step that it reads in.
void free_measured_initial_states(BoundSimulator& bound, const std::vector<std::size_t>& training);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/sensor_noise.ipp"
#endif
