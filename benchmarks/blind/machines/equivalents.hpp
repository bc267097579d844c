// Other descriptions of an effect that no test on these recordings could tell from it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "draw_case.hpp"

namespace machines {

/// When two descriptions are the same in the recordings.
struct Same {
  /// Sum of squared differences of their noise-free readings, in standard deviations of the noise, over all recordings:
  /// twice the logarithm of the likelihood ratio that the best of all tests would have on average.
  double most_squares = 4;
  /// Recordings that are compared (the sum is scaled up), and integration steps per row of both: enough to tell.
  std::size_t recordings = 3;
  int substeps = 3, substeps_of_delays = 10;
};

/// Names and places, as of drawn.hidden[k]: the same effect at every other place, and other effects that are known to
/// coincide with it in some machines. Each is fitted, with the parameters of the model, to noise-free readings.
std::vector<std::pair<std::string, std::string>> equivalents(const Drawn& drawn, std::size_t k, const Same& same = {});

}  // namespace machines
