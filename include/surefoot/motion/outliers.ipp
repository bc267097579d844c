// Definitions of surefoot/motion/outliers.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/fit/pose_filter.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"
#include "surefoot/motion/outliers.hpp"

namespace surefoot {

namespace detail {

SUREFOOT_INLINE double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Median of a chi-square with as many degrees of freedom (Wilson and Hilferty 1931).
SUREFOOT_INLINE double chi_square_median(double freedoms) { return freedoms * std::pow(1 - 2.0 / (9.0 * freedoms), 3); }

}  // namespace detail

SUREFOOT_INLINE std::vector<SequenceOutlier> find_outliers(const AnyMotionModel& start,
                                                           std::span<const WalkSequence> sequences,
                                                           const CalibrationOptions& options) {
  constexpr double once_in_a_million = 4.75;  // [standard deviations of a normal number]
  constexpr double least_ratio = 1e-9;        // poses that fit exactly must not make all others outliers
  std::vector<WalkSequence> finals(sequences.begin(), sequences.end());
  for (WalkSequence& sequence : finals) sequence = final_pose_only(std::move(sequence));
  CalibrationOptions robust = options;
  robust.model.loss = Loss::huber;
  const AnyCalibration fit = calibrate(finals, robust, start);
  std::vector<Innovation> last;
  std::vector<double> relative, distances;
  for (const WalkSequence& sequence : finals) {
    last.push_back(innovations(fit.model, fit.noise, options.model.accuracy, sequence).back());
    const Innovation& innovation = last.back();
    relative.push_back(innovation.whitened().squaredNorm() /
                       detail::chi_square_median(static_cast<double>(innovation.error.size())));
    distances.push_back(innovation.error.head<2>().norm());
  }
  const double ratio = std::max(detail::median_of(relative), least_ratio), typical = detail::median_of(distances);
  std::vector<SequenceOutlier> outliers;
  for (std::size_t i = 0; i < finals.size(); ++i) {
    const Surprise surprise{last[i].whitened().squaredNorm() / ratio, last[i].error.size()};
    if (!(surprise.deviations() > once_in_a_million)) continue;
    const double turned = last[i].error.size() == 3 ? last[i].error[2] : 0;
    outliers.push_back({.sequence = i, .distance = distances[i], .typical = typical, .turned = turned});
  }
  return outliers;
}

}  // namespace surefoot
