// Noise of a sensor from the fast part of what a model leaves, where errors of the model have little.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/simulation/bound_simulator.hpp"

namespace surefoot::diagnosis {

/// Residuals of one output in each recording that misses few of its readings, and whose run is finite; what is missing
/// is filled in between.
std::vector<Eigen::VectorXd> filled_series(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                           const std::vector<SimulatedRun>& runs, Eigen::Index output);

/// Power of residuals at frequencies whose periods are eight rows to two, by Welch's method (1967): tapered chunks of
/// 64 rows that overlap by half, third differences before (they remove what is slow), the median over chunks instead
/// of the mean (a jump of the model's error is in few of them). Empty if there are fewer than eight chunks.
struct FastSpectrum {
  std::vector<double> frequency;  // [rad per row]
  std::vector<double> power;      // of white noise: its variance, at each
};

/// Of series without NaN. Cost: 50 rows * 64.
FastSpectrum fast_spectrum(const std::vector<Eigen::VectorXd>& series);

/// Noise x' = rho x + e, white or fading from row to row.
struct FadingNoise {
  double deviation = 0;  // of x
  double rho = 0;        // share that the next row keeps
  bool slow = false;     // rho would be more than 0.9
};

/// The noise whose power s^2 / |1 - rho e^(-iw)|^2 fits best in logarithms. Where it is slow, what falls so is the
/// model's error, if anything lasts for more than ten rows, and the noise as if it were white, by the fastest
/// frequency. 0 if the spectrum is empty, or nothing is left at some frequency.
FadingNoise noise_from_spectrum(const FastSpectrum& spectrum);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/noise_spectrum.ipp"
#endif
