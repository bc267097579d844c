// Ends of readings: limits of a position or a level show as the largest or smallest values that were ever read.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// The reading that a share of all readings lies below.
[[gnu::cold]] inline double quantile(Values readings, double share) {
  std::vector<double> sorted(readings.begin(), readings.end());
  const auto at = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(sorted.size() - 1)));
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  return sorted[static_cast<std::size_t>(at)];
}

/// Near the largest readings; none where there are too few readings to tell noise from a limit.
[[gnu::cold]] inline std::vector<double> near_largest(Values readings, Values) {
  if (readings.size() < 50) return {};
  return {quantile(readings, 0.998), quantile(readings, 0.98)};
}

[[gnu::cold]] inline std::vector<double> near_smallest(Values readings, Values) {
  if (readings.size() < 50) return {};
  return {quantile(readings, 0.002), quantile(readings, 0.02)};
}

}  // namespace surefoot::effects
