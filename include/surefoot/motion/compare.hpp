// Comparison of motion models by how well they predict final poses of sequences that they were not fitted to.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/fit/predictor.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

struct CompareOptions {
  PredictorOptions predictor = {};
  std::size_t folds = 10;
  double tolerance = 1;           // a simpler model is preferred if it is behind by at most this [standard errors]
  double negligible_loss = 0.02;  // or by no more than this share of the error
};

/// Throws MotionError, naming the field.
void check(const CompareOptions& options);

/// Errors of one model: root mean squares over the sequences.
struct ModelEvaluation {
  std::string name;
  int parameters = 0;         // 0: the commands as they are
  double position = 0;        // [m]
  double position_error = 0;  // its standard error [m]
  double heading = 0;         // [rad]; NaN if no heading was measured
  bool chosen = false;
};

/// A model on sequences that it was not fitted to.
ModelEvaluation evaluate_on(const AnyMotionModel& model, std::span<const WalkSequence> sequences);

/// The prediction that the robot does what it is told, on these sequences.
ModelEvaluation evaluate_commands(std::span<const WalkSequence> sequences);

namespace detail {

/// A robot that does what it is told; nothing to fit.
struct CommandsAsTheyAre {
  static constexpr int parameter_count = 1;
  static constexpr std::string_view name = "commands as they are";
  static std::array<ModelParameter, 1> parameter_info() { return {{{"unused", "1", 0, 1}}}; }
  static CommandsAsTheyAre from_parameters(const Vec<1>& /*p*/) { return {}; }
  Vec<1> parameters() const { return Vec<1>::Zero(); }
  Pose2 displacement(const Vec<3>& command) const { return Pose2::from_vec(command); }
};

/// Indices 0 ... count - 1 in random order.
std::vector<std::size_t> shuffled_indices(std::size_t count, Rng& rng);

/// Standard error of the mean; infinite for a single value.
double standard_error(const Eigen::ArrayXd& values);

/// Squared errors of final positions [m^2] and headings [rad^2] by sequence.
struct HeldoutErrors {
  Eigen::ArrayXd position, heading;
  static constexpr auto fields = std::tuple(&HeldoutErrors::position, &HeldoutErrors::heading);
};

HeldoutErrors final_pose_errors(const AnyMotionModel& model, std::span<const WalkSequence> sequences);

/// The fits of one model to all folds but one, as independent jobs.
class FoldedFits {
 public:
  FoldedFits(const AnyMotionModel& start, std::span<const WalkSequence> sequences, const CompareOptions& options,
             std::uint64_t seed);

  std::size_t folds() const { return folds_; }

  /// Errors on a fold of the model that is fitted to the others.
  HeldoutErrors run(std::size_t fold) const;

  /// Errors by sequence.
  HeldoutErrors combine(const std::vector<HeldoutErrors>& by_fold) const;

 private:
  AnyMotionModel start_;
  std::span<const WalkSequence> sequences_;
  const CompareOptions& options_;
  std::uint64_t seed_;
  std::vector<std::size_t> shuffled_;
  std::size_t folds_;
  MotionNoise noise_;
};

/// Scores of all models, in the order of their errors, the first being that of the commands as they are.
std::vector<ModelEvaluation> choose_model(std::span<const AnyMotionModel> models, const std::vector<HeldoutErrors>& errors,
                                     const CompareOptions& options);

}  // namespace detail

/// The commands as they are, then each model, in the order given: give simpler ones first. The chosen one is the first
/// that is behind the best by no more than `tolerance` standard errors of the difference between the two, or by no more
/// than the negligible loss. Throws MotionError if there are fewer than two sequences.
template <Executor E>
std::vector<ModelEvaluation> compare_models(std::span<const AnyMotionModel> models, std::span<const WalkSequence> sequences,
                                       const CompareOptions& options, const E& executor, std::uint64_t seed) {
  check(options);
  check(sequences);
  if (sequences.size() < 2) throw MotionError("compare_models: at least two sequences are needed to leave one out");
  std::vector<detail::HeldoutErrors> errors{detail::final_pose_errors(detail::CommandsAsTheyAre{}, sequences)};
  for (const AnyMotionModel& model : models) {
    const detail::FoldedFits fits(model, sequences, options, seed);
    errors.push_back(fits.combine(map(executor, fits.folds(), [&](std::size_t fold) { return fits.run(fold); })));
  }
  return detail::choose_model(models, errors, options);
}

/// The same for models of these types, each from its default on.
template <MotionModel... Models, Executor E>
std::vector<ModelEvaluation> compare_models(std::span<const WalkSequence> sequences, const CompareOptions& options,
                                       const E& executor, std::uint64_t seed) {
  const std::vector<AnyMotionModel> models{Models()...};
  return compare_models(std::span<const AnyMotionModel>(models), sequences, options, executor, seed);
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/compare.ipp"
#endif
