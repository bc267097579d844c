// Definitions of surefoot/motion/compare.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/compare.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const CompareOptions& options) {
  check(options.predictor.calibration);
  check(options.predictor.published);
  if (options.folds < 2) {
    throw MotionError("CompareOptions: folds must be at least 2, got " + std::to_string(options.folds));
  }
  if (!(options.tolerance >= 0 && options.negligible_loss >= 0)) {
    throw MotionError("CompareOptions: tolerance and negligible_loss must not be negative");
  }
}

namespace detail {

SUREFOOT_INLINE std::vector<std::size_t> shuffled_indices(std::size_t count, Rng& rng) {
  std::vector<std::size_t> indices(count);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) std::swap(indices[i - 1], indices[rng.below(static_cast<std::uint32_t>(i))]);
  return indices;
}

SUREFOOT_INLINE double standard_error(const Eigen::ArrayXd& values) {
  const auto count = static_cast<double>(values.size());
  return count > 1 ? std::sqrt((values - values.mean()).square().sum() / (count - 1) / count) : INFINITY;
}

SUREFOOT_INLINE double mean_of_finite(const Eigen::ArrayXd& values) {
  const Eigen::ArrayXd finite = values.isFinite().select(values, 0.0);
  return finite.sum() / static_cast<double>(values.isFinite().count());
}

SUREFOOT_INLINE HeldoutErrors final_pose_errors(const AnyMotionModel& model, std::span<const WalkSequence> sequences) {
  const auto count = static_cast<Eigen::Index>(sequences.size());
  HeldoutErrors errors{Eigen::ArrayXd(count), Eigen::ArrayXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const FinalPoseError error = final_pose_error(model, sequences.subspan(static_cast<std::size_t>(i), 1));
    errors.position[i] = error.position * error.position;
    errors.heading[i] = error.heading * error.heading;
  }
  return errors;
}

SUREFOOT_INLINE ModelEvaluation score(std::string name, Eigen::Index parameters, const HeldoutErrors& errors) {
  constexpr double least = 1e-12;  // [m]: a model without any error is no less known
  ModelEvaluation result{.name = std::move(name), .parameters = static_cast<int>(parameters)};
  result.position = std::sqrt(errors.position.mean());
  result.position_error = standard_error(errors.position) / (2 * std::max(result.position, least));
  result.heading = std::sqrt(mean_of_finite(errors.heading));
  return result;
}

SUREFOOT_INLINE FoldedFits::FoldedFits(const AnyMotionModel& start, std::span<const WalkSequence> sequences,
                                       const CompareOptions& options, std::uint64_t seed)
    : start_(start),
      sequences_(sequences),
      options_(options),
      seed_(seed),
      folds_(std::min(options.folds, sequences.size())) {
  Rng rng(seed);
  shuffled_ = shuffled_indices(sequences.size(), rng);
  noise_ = calibrate(sequences, options.predictor.calibration, start).noise;
}

SUREFOOT_INLINE HeldoutErrors FoldedFits::run(std::size_t fold) const {
  std::vector<WalkSequence> fitted, held_out;
  for (std::size_t i = 0; i < shuffled_.size(); ++i) {
    (i % folds_ != fold ? fitted : held_out).push_back(sequences_[shuffled_[i]]);
  }
  return final_pose_errors(fit_predictor(start_, fitted, noise_, options_.predictor, seed_ + fold), held_out);
}

SUREFOOT_INLINE HeldoutErrors FoldedFits::combine(const std::vector<HeldoutErrors>& by_fold) const {
  const auto count = static_cast<Eigen::Index>(sequences_.size());
  HeldoutErrors errors{Eigen::ArrayXd(count), Eigen::ArrayXd(count)};
  for (std::size_t i = 0; i < shuffled_.size(); ++i) {
    const auto to = static_cast<Eigen::Index>(shuffled_[i]), from = static_cast<Eigen::Index>(i / folds_);
    errors.position[to] = by_fold[i % folds_].position[from];
    errors.heading[to] = by_fold[i % folds_].heading[from];
  }
  return errors;
}

SUREFOOT_INLINE std::vector<ModelEvaluation> choose_model(std::span<const AnyMotionModel> models,
                                                     const std::vector<HeldoutErrors>& errors,
                                                     const CompareOptions& options) {
  std::vector<ModelEvaluation> scores{score(std::string(CommandsAsTheyAre::name), 0, errors[0])};
  for (std::size_t i = 0; i < models.size(); ++i) {
    scores.push_back(score(models[i].name(), models[i].parameter_count(), errors[i + 1]));
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < scores.size(); ++i) {
    if (scores[i].position < scores[best].position) best = i;
  }
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const Eigen::ArrayXd behind = errors[i].position - errors[best].position;
    const bool certain = behind.mean() > options.tolerance * standard_error(behind);
    if (certain && scores[i].position > (1 + options.negligible_loss) * scores[best].position) continue;
    scores[i].chosen = true;
    break;
  }
  return scores;
}

}  // namespace detail

SUREFOOT_INLINE ModelEvaluation evaluate_on(const AnyMotionModel& model, std::span<const WalkSequence> sequences) {
  return detail::score(model.name(), model.parameter_count(), detail::final_pose_errors(model, sequences));
}

SUREFOOT_INLINE ModelEvaluation evaluate_commands(std::span<const WalkSequence> sequences) {
  return detail::score(std::string(detail::CommandsAsTheyAre::name), 0,
                       detail::final_pose_errors(detail::CommandsAsTheyAre{}, sequences));
}

}  // namespace surefoot
