// Which motion model predicts best where a robot ends, judged on sequences it was not fitted to.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/motion/fit/predictor.hpp"

namespace surefoot {

struct CompareOptions {
  PredictorOptions predictor = {};
  std::size_t folds = 10;
  double clearly = 1;     // a simpler model is preferred if it is behind by at most this [standard errors]
  double matters = 0.02;  // or by no more than this share of the error
};

/// One model, judged. Errors are root mean squares over the sequences, each predicted by a fit to the other folds.
struct ModelScore {
  std::string name;
  int parameters = 0;         // 0: the commands as they are
  double position = 0;        // [m]
  double position_error = 0;  // its standard error [m]
  double heading = 0;         // [rad]; NaN if no heading was measured
  bool chosen = false;
};

/// Numbers 0 ... count - 1 in random order.
inline std::vector<std::size_t> shuffled_indices(std::size_t count, Rng& rng) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[rng.below(static_cast<std::uint32_t>(i))]);
  return order;
}

namespace detail {

/// Squared errors of final positions [m^2] and headings [rad^2] by sequence, each left out when its model was fitted.
struct HeldoutErrors {
  Eigen::ArrayXd position, heading;
  static constexpr auto fields = std::tuple(&HeldoutErrors::position, &HeldoutErrors::heading);
};

template <MotionModel M>
void judge_final_pose(const M& model, const WalkSequence& sequence, Eigen::Index at, HeldoutErrors& errors) {
  const FinalPoseError error = final_pose_error(model, std::span<const WalkSequence>(&sequence, 1));
  errors.position[at] = error.position * error.position;
  errors.heading[at] = error.heading * error.heading;
}

template <MotionModel M, Executor E>
HeldoutErrors heldout_errors(std::span<const WalkSequence> sequences, const CompareOptions& options, const E& executor,
                             std::uint64_t seed) {
  Rng rng(seed);
  const std::vector<std::size_t> order = shuffled_indices(sequences.size(), rng);
  const std::size_t folds = std::min(options.folds, sequences.size());
  const MotionNoise noise = calibrate<M>(sequences, options.predictor.calibration).noise;
  const auto parts = map(executor, folds, [&](std::size_t fold) {
    std::vector<WalkSequence> fit, judged;
    for (std::size_t i = 0; i < order.size(); ++i) (i % folds != fold ? fit : judged).push_back(sequences[order[i]]);
    const M model = fit_predictor<M>(fit, noise, options.predictor, seed + fold);
    const auto count = static_cast<Eigen::Index>(judged.size());
    HeldoutErrors errors{Eigen::ArrayXd(count), Eigen::ArrayXd(count)};
    for (std::size_t i = 0; i < judged.size(); ++i) {
      judge_final_pose(model, judged[i], static_cast<Eigen::Index>(i), errors);
    }
    return errors;
  });
  const auto count = static_cast<Eigen::Index>(sequences.size());
  HeldoutErrors errors{Eigen::ArrayXd(count), Eigen::ArrayXd(count)};
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto to = static_cast<Eigen::Index>(order[i]), from = static_cast<Eigen::Index>(i / folds);
    errors.position[to] = parts[i % folds].position[from];
    errors.heading[to] = parts[i % folds].heading[from];
  }
  return errors;
}

inline double mean_of_finite(const Eigen::ArrayXd& values) {
  const Eigen::ArrayXd finite = values.isFinite().select(values, 0.0);
  return finite.sum() / static_cast<double>(values.isFinite().count());
}

inline double standard_error(const Eigen::ArrayXd& values) {
  const auto count = static_cast<double>(values.size());
  return count > 1 ? std::sqrt((values - values.mean()).square().sum() / (count - 1) / count) : INFINITY;
}

inline ModelScore score(std::string name, int parameters, const HeldoutErrors& errors) {
  ModelScore result{.name = std::move(name), .parameters = parameters};
  result.position = std::sqrt(errors.position.mean());
  result.position_error = standard_error(errors.position) / (2 * std::max(result.position, 1e-12));
  result.heading = std::sqrt(mean_of_finite(errors.heading));
  return result;
}

/// Does what it is told; nothing to fit.
struct AsOrdered {
  static constexpr int parameter_count = 1;
  static std::array<ModelParameter, 1> parameter_info() { return {{{"unused", "1", 0, 1}}}; }
  static AsOrdered from_parameters(const Vec<1>& /*p*/) { return {}; }
  Vec<1> parameters() const { return Vec<1>::Zero(); }
  Pose2 displacement(const Vec<3>& commands) const { return Pose2::from_vec(commands); }
};

}  // namespace detail

/// The commands as they are, then each model, in the order named: name simpler ones first. The chosen one is the first
/// that is behind the best by no more than `clearly` standard errors of the difference between the two, or by no more
/// than what matters. Throws MotionError if there are fewer than two sequences.
template <MotionModel... Models, Executor E>
std::vector<ModelScore> compare_models(std::span<const WalkSequence> sequences, const CompareOptions& options,
                                       const E& executor, std::uint64_t seed) {
  check(sequences);
  if (sequences.size() < 2) throw MotionError("compare_models: at least two sequences are needed to leave one out");
  const auto count = static_cast<Eigen::Index>(sequences.size());
  std::vector<detail::HeldoutErrors> errors{{Eigen::ArrayXd(count), Eigen::ArrayXd(count)}};
  for (Eigen::Index i = 0; i < count; ++i) {
    detail::judge_final_pose(detail::AsOrdered{}, sequences[static_cast<std::size_t>(i)], i, errors[0]);
  }
  std::vector<ModelScore> scores{detail::score("commands as they are", 0, errors[0])};
  (
      [&] {
        errors.push_back(detail::heldout_errors<Models>(sequences, options, executor, seed));
        scores.push_back(detail::score(model_name<Models>(), Models::parameter_count, errors.back()));
      }(),
      ...);
  std::size_t best = 0;
  for (std::size_t i = 1; i < scores.size(); ++i) {
    if (scores[i].position < scores[best].position) best = i;
  }
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const Eigen::ArrayXd behind = errors[i].position - errors[best].position;
    const bool certain = behind.mean() > options.clearly * detail::standard_error(behind);
    if (certain && scores[i].position > (1 + options.matters) * scores[best].position) continue;
    scores[i].chosen = true;
    break;
  }
  return scores;
}

}  // namespace surefoot
