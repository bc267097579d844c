// Definitions of surefoot/motion/plan/learning_curve.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/motion/compare.hpp"
#include "surefoot/motion/plan/learning_curve.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const LearningCurveOptions& options) {
  check(options.predictor.calibration);
  check(options.predictor.published);
  if (options.validation < 1) throw MotionError("LearningCurveOptions: validation must be at least 1, got 0");
  if (options.repetitions < 1) throw MotionError("LearningCurveOptions: repetitions must be at least 1, got 0");
}

namespace detail {

SUREFOOT_INLINE LearningCurveSplits::LearningCurveSplits(const AnyMotionModel& start,
                                                         std::span<const WalkSequence> sequences,
                                                         const LearningCurveOptions& options, std::uint64_t seed)
    : start_(start), sequences_(sequences), options_(options), seed_(seed), counts_(options.counts) {
  check(options);
  check(sequences);
  if (sequences.size() <= options.validation) {
    throw MotionError("learning_curve: " + std::to_string(sequences.size()) + " sequence(s) are too few to keep " +
                      std::to_string(options.validation) + " for validation");
  }
  const std::size_t most = sequences.size() - options.validation;
  if (counts_.empty()) {
    for (std::size_t count = 1; count <= most; ++count) counts_.push_back(count);
  }
  for (const std::size_t count : counts_) {
    if (count == 0 || count > most)
      throw MotionError("LearningCurveOptions: counts must be from 1 to all but the held-out sequences");
  }
  noise_ = options.noise ? *options.noise : calibrate(sequences, options.predictor.calibration, start).noise;
}

SUREFOOT_INLINE std::vector<SplitResult> LearningCurveSplits::run(std::size_t repetition) const {
  Rng rng(seed_, repetition);
  std::vector<WalkSequence> shuffled;
  for (const std::size_t i : shuffled_indices(sequences_.size(), rng)) shuffled.push_back(sequences_[i]);
  const std::span<const WalkSequence> all(shuffled);
  const std::size_t held_out = options_.validation;
  std::vector<SplitResult> result;
  for (const std::size_t count : counts_) {
    const AnyMotionModel model = fit_predictor(start_, all.subspan(held_out, count), noise_, options_.predictor, seed_);
    result.push_back({final_pose_error(model, all.first(held_out)).position, model.parameters()});
  }
  return result;
}

SUREFOOT_INLINE LearningCurve LearningCurveSplits::curve(const std::vector<std::vector<SplitResult>>& results) const {
  constexpr double confident = 1.96;  // standard errors of a 95 % confidence interval
  LearningCurve curve;
  curve.model = start_.name();
  curve.counts = counts_;
  curve.position.setZero(static_cast<Eigen::Index>(counts_.size()));
  curve.position_half_width = curve.position;
  curve.coefficients.setZero(start_.parameter_count(), curve.position.size());
  curve.coefficients_deviation = curve.coefficients;
  const auto n = static_cast<double>(results.size());
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    Eigen::ArrayXd positions(static_cast<Eigen::Index>(results.size()));
    for (std::size_t r = 0; r < results.size(); ++r) {
      positions[static_cast<Eigen::Index>(r)] = results[r][k].position;
      curve.coefficients.col(at) += results[r][k].parameters / n;
    }
    for (const std::vector<SplitResult>& result : results) {
      curve.coefficients_deviation.col(at).array() +=
          (result[k].parameters - curve.coefficients.col(at)).array().square() / n;
    }
    curve.position[at] = positions.mean();
    curve.position_half_width[at] = confident * standard_error(positions);
  }
  curve.coefficients_deviation = curve.coefficients_deviation.cwiseSqrt();
  return curve;
}

}  // namespace detail

SUREFOOT_INLINE MoreSequences more_sequences(const LearningCurve& curve, std::size_t have) {
  double sw = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < curve.counts.size(); ++k) {
    const auto count = static_cast<double>(curve.counts[k]);
    if (2 * curve.counts[k] < curve.counts.back() && k + 3 < curve.counts.size()) continue;
    const double x = 1 / count, y = std::pow(curve.position[static_cast<Eigen::Index>(k)], 2), w = count;
    sw += w, sx += w * x, sy += w * y, sxx += w * x * x, sxy += w * x * y;
  }
  const double determinant = sw * sxx - sx * sx;
  const double slope = determinant > 0 ? std::max(0.0, (sw * sxy - sx * sy) / determinant) : 0;
  const double floor = std::max(1e-12, (sy - slope * sx) / sw);
  MoreSequences result{.have = have};
  result.limit = std::sqrt(floor);
  result.now = std::sqrt(floor + slope / static_cast<double>(std::max<std::size_t>(have, 1)));
  const double enough = slope / (floor * (1.05 * 1.05 - 1));
  if (enough > static_cast<double>(have)) result.worthwhile = static_cast<std::size_t>(std::ceil(enough)) - have;
  return result;
}

}  // namespace surefoot
