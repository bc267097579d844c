// Threshold of a change alarm: how much evidence it must ask for so that it is rarely false, found by walking as
// calibrated, many times, in simulation.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/motion/monitor/change_alarm.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

struct ThresholdOptions {
  double false_alarms = 0.01;  // share of runs with a false alarm, at most
  int run_length = 100;        // [sequences]
  int runs = 1000;             // simulated; about 20 ms each
  double confidence = 0.9;     // that the share is kept although the runs are finitely many
  double noise_error = 0;      // relative standard error of each deviation of the noise, if it was estimated too
  AlarmOptions alarm = {};     // as the alarm will be used
};

/// Throws MotionError, naming the field; also for so few runs that no threshold can be given with that confidence.
void check(const ThresholdOptions& options);

namespace detail {

/// The runs of the simulation, as independent jobs.
class AlarmSimulation {
 public:
  AlarmSimulation(const MotionTracker& calibrated, std::span<const WalkSequence> like, const ThresholdOptions& options,
                  std::uint64_t seed);

  /// The most evidence in a run [nats].
  double run(std::size_t run) const;

  /// What the most evidence of all runs makes of the threshold.
  double threshold(std::vector<double> most) const;

 private:
  const MotionTracker& calibrated_;
  std::span<const WalkSequence> like_;
  const ThresholdOptions& options_;
  std::uint64_t seed_;
  Eigen::MatrixXd root_;  // lower Cholesky factor of the covariance of the parameters
};

/// The largest m for which at least m of `runs` events of probability `share` happen with this confidence: the m-th
/// largest of as many draws is above the quantile 1 - share that surely. 0 if there is none.
int safe_rank(int runs, double share, double confidence);

}  // namespace detail

/// The threshold [nats] for an alarm that starts from this tracker, for sequences with the commands and measured poses
/// of `like` (drawn with replacement). In each run the robot's parameters are drawn from what the calibration knows of
/// them. The same for every executor. Throws MotionError for options that fail the check and sequences that cannot be
/// used.
template <Executor E>
double alarm_threshold(const MotionTracker& calibrated, std::span<const WalkSequence> like,
                       const ThresholdOptions& options, const E& executor, std::uint64_t seed) {
  const detail::AlarmSimulation simulation(calibrated, like, options, seed);
  return simulation.threshold(
      map(executor, static_cast<std::size_t>(options.runs), [&](std::size_t run) { return simulation.run(run); }));
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/monitor/alarm_threshold.ipp"
#endif
