// How the error of a calibrated motion model falls with the number of sequences it was calibrated from, by repeated
// random splits: figures 3 and 4 of Hofer and Rouxel, ICAPS 2017.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <tuple>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/motion/compare.hpp"

namespace surefoot {

struct LearningCurveOptions {
  PredictorOptions predictor = {};
  std::vector<std::size_t> counts = {};   // of sequences to fit to, rising; empty: 1, 2, ... all but those that judge
  std::size_t validation = 5;             // sequences that judge each fit
  std::size_t repetitions = 200;          // random splits
  std::optional<MotionNoise> noise = {};  // that weighs the likelihood; none: calibrated from all sequences
  // After each repetition of this process, from any thread, one at a time.
  std::function<void(std::size_t done)> on_progress = {};
};

struct LearningCurve {
  std::string model;
  std::vector<std::size_t> counts;
  Eigen::ArrayXd position;              // by count: mean over the splits of the root mean square error [m]
  Eigen::ArrayXd position_half_width;   // of its 95 % confidence interval [m]
  Eigen::MatrixXd coefficients;         // parameter x count: mean over the splits
  Eigen::MatrixXd coefficients_spread;  // parameter x count: standard deviation over the splits
};

namespace detail {

struct SplitResult {
  double position = 0;
  Eigen::VectorXd parameters;
  static constexpr auto fields = std::tuple(&SplitResult::position, &SplitResult::parameters);
};

}  // namespace detail

/// Throws MotionError if there are too few sequences, or if `stop` came before all was done.
template <MotionModel M, Executor E>
LearningCurve learning_curve(std::span<const WalkSequence> sequences, const LearningCurveOptions& options,
                             const E& executor, std::uint64_t seed, std::stop_token stop = {}) {
  check(sequences);
  if (sequences.size() <= options.validation) {
    throw MotionError("learning_curve: " + std::to_string(sequences.size()) + " sequence(s) are too few to keep " +
                      std::to_string(options.validation) + " for validation");
  }
  LearningCurve curve;
  curve.model = model_name<M>();
  curve.counts = options.counts;
  const std::size_t most = sequences.size() - options.validation;
  if (curve.counts.empty()) {
    for (std::size_t count = 1; count <= most; ++count) curve.counts.push_back(count);
  }
  for (const std::size_t count : curve.counts) {
    if (count == 0 || count > most)
      throw MotionError("LearningCurveOptions: counts must be from 1 to all but those that judge");
  }
  const MotionNoise noise =
      options.noise ? *options.noise : calibrate<M>(sequences, options.predictor.calibration).noise;
  std::mutex reporting;
  std::size_t done = 0;
  const std::size_t points = curve.counts.size();
  const auto results = map(
      executor, options.repetitions,
      [&](std::size_t repetition) {
        Rng rng(seed, repetition);
        std::vector<WalkSequence> shuffled;
        for (const std::size_t i : shuffled_indices(sequences.size(), rng)) shuffled.push_back(sequences[i]);
        const std::span<const WalkSequence> all(shuffled);
        std::vector<detail::SplitResult> result;
        for (const std::size_t count : curve.counts) {
          const M model = fit_predictor<M>(all.subspan(options.validation, count), noise, options.predictor, seed);
          result.push_back(
              {final_pose_error(model, all.first(options.validation)).position, Eigen::VectorXd(model.parameters())});
        }
        if (options.on_progress) {
          const std::scoped_lock lock(reporting);
          options.on_progress(++done);
        }
        return result;
      },
      std::move(stop));

  curve.position.setZero(static_cast<Eigen::Index>(points));
  curve.position_half_width = curve.position;
  curve.coefficients.setZero(M::parameter_count, static_cast<Eigen::Index>(points));
  curve.coefficients_spread = curve.coefficients;
  const auto n = static_cast<double>(options.repetitions);
  for (std::size_t k = 0; k < points; ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    Eigen::ArrayXd positions(static_cast<Eigen::Index>(options.repetitions));
    for (std::size_t r = 0; r < options.repetitions; ++r) {
      positions[static_cast<Eigen::Index>(r)] = results[r][k].position;
      curve.coefficients.col(at) += results[r][k].parameters / n;
    }
    for (std::size_t r = 0; r < options.repetitions; ++r) {
      curve.coefficients_spread.col(at).array() +=
          (results[r][k].parameters - curve.coefficients.col(at)).array().square() / n;
    }
    curve.position[at] = positions.mean();
    curve.position_half_width[at] = 1.96 * detail::standard_error(positions);
  }
  curve.coefficients_spread = curve.coefficients_spread.cwiseSqrt();
  return curve;
}

/// What more sequences would bring.
struct MoreSequences {
  std::size_t have = 0;
  double now = 0, limit = 0;   // error with all of them, and with any number [m]
  std::size_t worthwhile = 0;  // how many more bring the error within 5 % of the limit; 0: it is there
};

/// Extrapolates the upper half of a curve by error^2 = limit^2 + c / count, which holds once all coefficients are
/// determined: the part of the variance that comes from them falls with the number of sequences.
inline MoreSequences more_sequences(const LearningCurve& curve, std::size_t have) {
  double sw = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < curve.counts.size(); ++k) {
    const auto count = static_cast<double>(curve.counts[k]);
    if (2 * curve.counts[k] < curve.counts.back() && k + 3 < curve.counts.size()) continue;
    const double x = 1 / count, y = std::pow(curve.position[static_cast<Eigen::Index>(k)], 2), w = count;
    sw += w, sx += w * x, sy += w * y, sxx += w * x * x, sxy += w * x * y;
  }
  const double spread = sw * sxx - sx * sx;
  const double slope = spread > 0 ? std::max(0.0, (sw * sxy - sx * sy) / spread) : 0;
  const double floor = std::max(1e-12, (sy - slope * sx) / sw);
  MoreSequences result{.have = have};
  result.limit = std::sqrt(floor);
  result.now = std::sqrt(floor + slope / static_cast<double>(std::max<std::size_t>(have, 1)));
  const double enough = slope / (floor * (1.05 * 1.05 - 1));
  if (enough > static_cast<double>(have)) result.worthwhile = static_cast<std::size_t>(std::ceil(enough)) - have;
  return result;
}

}  // namespace surefoot
