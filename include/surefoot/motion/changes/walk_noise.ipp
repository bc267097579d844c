// Definitions of surefoot/motion/changes/walk_noise.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/changes/walk_noise.hpp"
#include "surefoot/motion/fit/noise_fit.hpp"

namespace surefoot::detail {

SUREFOOT_INLINE MotionNoise noise_with_growth(const AnyMotionModel& model, std::span<const WalkSequence> sequences,
                                              const MotionNoise& constant, const PoseAccuracy& accuracy) {
  constexpr std::size_t least = 100;  // cycles, to tell three terms of each component
  if (!sees_single_cycles(sequences)) return constant;
  const std::vector<CycleDeviation> cycles = cycle_deviations(model, sequences);
  if (cycles.size() < least) return constant;
  return fit_cycle_noise(cycles, NoiseShape::gaussian, NoiseGrowth::with_speed_and_acceleration,
                         {.accuracy = accuracy, .scale = constant.scale}, static_cast<int>(model.parameter_count()));
}

/// Squared deviations of one component, in units of what the noise makes them: the mean of each sequence.
struct ComponentSquares {
  Eigen::VectorXd means;     // by sequence that has any
  double cycles = 0;         // of all
  double mean_variance = 0;  // of the noise alone, over all cycles [m^2 or rad^2]
};

SUREFOOT_INLINE ComponentSquares component_squares(const WalkWithFit& walk, Eigen::Index axis, const MotionNoise& noise,
                                                   const PoseAccuracy& accuracy) {
  ComponentSquares result;
  std::vector<double> means;
  for (const WalkSequence& sequence : walk.sequences) {
    const std::vector<CycleDeviation> cycles = cycle_deviations(walk.fit.model, std::span(&sequence, 1));
    double sum = 0;
    for (const CycleDeviation& cycle : cycles) {
      const double deviation = noise.deviation(cycle.commands, cycle.previous)[axis];
      const double variance = deviation * deviation + 2 * accuracy.variance()[axis];  // both ends are measured
      sum += cycle.value[axis] * cycle.value[axis] / std::max(variance, 1e-20);
      result.mean_variance += deviation * deviation;
    }
    if (cycles.empty()) continue;
    means.push_back(sum / static_cast<double>(cycles.size()));
    result.cycles += static_cast<double>(cycles.size());
  }
  result.means = Eigen::Map<const Eigen::VectorXd>(means.data(), static_cast<Eigen::Index>(means.size()));
  if (result.cycles > 0) result.mean_variance /= result.cycles;
  // What the coefficients took away, a third of them from each component.
  const double left = std::max(0.1, 1 - walk.fit.spent / 3 / std::max(result.cycles, 1.0));
  result.means /= left;
  return result;
}

/// Degrees of freedom of the old estimate by sequence are what is usual for the new one.
SUREFOOT_INLINE VarianceChange change_of(const std::optional<VarianceEstimate>& known, const Eigen::VectorXd& before,
                                         double values_before, const Eigen::VectorXd& after, double values_after,
                                         double deviation) {
  const auto count = static_cast<double>(before.size()), new_count = static_cast<double>(after.size());
  double usual = values_after / new_count;
  VarianceEstimate old = known.value_or(VarianceEstimate{});
  if (!known) {
    old = pooled_variance(before, values_before / count);
    usual = std::min(usual, old.freedoms / count);
  }
  return variance_change(old, pooled_variance(after, usual), deviation);
}

/// The factor of the standard deviation, drawn towards 1 with few degrees of freedom.
SUREFOOT_INLINE double noise_factor(double ratio, double values, double share_of_noise) {
  constexpr double weight = 10, least = 0.05;  // readings that the old noise counts as; share of its variance left
  const double drawn = (weight + values * ratio) / (weight + values);
  return std::sqrt(std::max(least, (drawn - (1 - share_of_noise)) / std::max(share_of_noise, least)));
}

SUREFOOT_INLINE void scale_axis(MotionNoise& noise, Eigen::Index axis, double factor) {
  noise.constant[axis] *= factor;
  noise.per_speed[axis] *= factor;
  noise.per_acceleration[axis] *= factor;
}

SUREFOOT_INLINE NoiseOfWalks compare_cycles(const WalkWithFit& before, const WalkWithFit& after,
                                            const MotionNoise& noise, const PoseAccuracy& accuracy, double deviation) {
  constexpr std::array<const char*, 3> names{"noise forward", "noise sideways", "noise of turns"};
  NoiseOfWalks result{.after = noise};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const ComponentSquares now = component_squares(after, axis, noise, accuracy);
    ComponentSquares then;
    std::optional<VarianceEstimate> known;
    if (before.sequences.empty()) {
      known = VarianceEstimate{.variance = 1, .freedoms = std::max(1.0, static_cast<double>(before.readings) / 3)};
    } else {
      then = component_squares(before, axis, noise, accuracy);
    }
    NoiseChange one{.name = names[static_cast<std::size_t>(axis)]};
    one.change = change_of(known, then.means, then.cycles, now.means, now.cycles, deviation);
    const double variance = std::max(now.mean_variance, 1e-20);
    const double share = variance / (variance + 2 * accuracy.variance()[axis]);
    const double factor = noise_factor(one.change.ratio, now.cycles, share);
    one.before = std::sqrt(now.mean_variance);
    one.after = factor * one.before;
    scale_axis(result.after, axis, factor);
    result.components.push_back(one);
  }
  return result;
}

SUREFOOT_INLINE NoiseOfWalks compare_noise(const WalkWithFit& before, const WalkWithFit& after,
                                           const MotionNoise& noise, const PoseAccuracy& accuracy, double deviation) {
  const bool cycles = sees_single_cycles(after.sequences) &&
                      (before.sequences.empty() || sees_single_cycles(before.sequences));
  if (cycles) return compare_cycles(before, after, noise, accuracy, deviation);
  const auto means = [](const SequenceFit& fit) {
    const double left = std::max(0.1, 1 - fit.spent / fit.counts.sum());
    return Eigen::VectorXd(fit.squares.cwiseQuotient(fit.counts) / left);
  };
  std::optional<VarianceEstimate> known;
  Eigen::VectorXd then;
  if (before.sequences.empty()) {
    known = VarianceEstimate{.variance = 1, .freedoms = std::max(1.0, static_cast<double>(before.readings))};
  } else {
    then = means(before.fit);
  }
  NoiseChange one{.name = "noise", .before = 1};
  one.change = change_of(known, then, known ? 0 : before.fit.counts.sum(), means(after.fit), after.fit.counts.sum(),
                         deviation);
  one.after = noise_factor(one.change.ratio, after.fit.counts.sum(), 1);
  NoiseOfWalks result{.components = {one}, .after = noise};
  for (Eigen::Index axis = 0; axis < 3; ++axis) scale_axis(result.after, axis, one.after);
  return result;
}

}  // namespace surefoot::detail
