// Learning curve of a motion model: how its error falls with the number of sequences it was calibrated from, by
// repeated random splits. Figures 3 and 4 of Hofer and Rouxel, ICAPS 2017.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/fit/predictor.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// Of one random split and one count of sequences fitted to.
struct SplitResult {
  double position = 0;         // root mean square error on the held-out sequences [m]
  Eigen::VectorXd parameters;  // of the fitted model
  static constexpr auto fields = std::tuple(&SplitResult::position, &SplitResult::parameters);
};

struct LearningCurveOptions {
  PredictorOptions predictor = {};
  std::vector<std::size_t> counts = {};   // of sequences to fit to, rising; empty: 1, 2, ... all but the held-out ones
  std::size_t validation = 5;             // held-out sequences, for each fit
  std::size_t repetitions = 200;          // random splits
  std::optional<MotionNoise> noise = {};  // that weighs the likelihood; none: calibrated from all sequences
  // After each repetition of this process, from any thread, one at a time.
  std::function<void(std::size_t done)> on_progress = {};
  // To go on with work that was stopped: a repetition's results by count, if they are known (from any thread); and
  // results that are new, one call at a time.
  std::function<std::optional<std::vector<SplitResult>>(std::size_t repetition)> known = {};
  std::function<void(std::size_t repetition, const std::vector<SplitResult>&)> on_split = {};
};

/// Throws MotionError, naming the field.
void check(const LearningCurveOptions& options);

struct LearningCurve {
  std::string model;
  std::vector<std::size_t> counts;
  Eigen::ArrayXd position;                 // by count: mean over the splits of the root mean square error [m]
  Eigen::ArrayXd position_half_width;      // of its 95 % confidence interval [m]
  Eigen::MatrixXd coefficients;            // parameter x count: mean over the splits
  Eigen::MatrixXd coefficients_deviation;  // parameter x count: standard deviation over the splits
};

namespace detail {

/// The random splits, as independent jobs.
class LearningCurveSplits {
 public:
  LearningCurveSplits(const AnyMotionModel& start, std::span<const WalkSequence> sequences,
                      const LearningCurveOptions& options, std::uint64_t seed);

  /// By count.
  std::vector<SplitResult> run(std::size_t repetition) const;

  LearningCurve curve(const std::vector<std::vector<SplitResult>>& results) const;

 private:
  AnyMotionModel start_;
  std::span<const WalkSequence> sequences_;
  const LearningCurveOptions& options_;
  std::uint64_t seed_;
  std::vector<std::size_t> counts_;
  MotionNoise noise_;
};

}  // namespace detail

/// The curve of the model `start` fitted from its parameters on. Throws MotionError if there are too few sequences, or
/// CoreError if `stop` came before all was done.
template <Executor E>
LearningCurve learning_curve(const AnyMotionModel& start, std::span<const WalkSequence> sequences,
                             const LearningCurveOptions& options, const E& executor, std::uint64_t seed,
                             std::stop_token stop = {}) {
  const detail::LearningCurveSplits splits(start, sequences, options, seed);
  std::mutex reporting;
  std::size_t done = 0;
  const auto job = [&](std::size_t repetition) {
    std::optional<std::vector<SplitResult>> known;
    if (options.known) known = options.known(repetition);
    std::vector<SplitResult> result = known ? *std::move(known) : splits.run(repetition);
    const std::scoped_lock lock(reporting);
    if (options.on_split && !known) options.on_split(repetition, result);
    if (options.on_progress) options.on_progress(++done);
    return result;
  };
  return splits.curve(map(executor, options.repetitions, job, std::move(stop)));
}

/// The same from the default model on.
template <MotionModel M, Executor E>
LearningCurve learning_curve(std::span<const WalkSequence> sequences, const LearningCurveOptions& options,
                             const E& executor, std::uint64_t seed, std::stop_token stop = {}) {
  return learning_curve(AnyMotionModel(M()), sequences, options, executor, seed, std::move(stop));
}

/// What more sequences would bring.
struct MoreSequences {
  std::size_t have = 0;
  double now = 0, limit = 0;   // error with all of them, and with any number [m]
  std::size_t worthwhile = 0;  // how many more bring the error within 5 % of the limit; 0: it is there
};

/// Extrapolates the upper half of a curve by error^2 = limit^2 + c / count, which holds once all coefficients are
/// determined: the part of the variance that comes from them falls with the number of sequences.
MoreSequences more_sequences(const LearningCurve& curve, std::size_t have);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/plan/learning_curve.ipp"
#endif
