// How much evidence a change alarm must ask for, so that it is rarely false: found by walking as calibrated, many
// times, in simulation.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/monitor/change_alarm.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"
#include "surefoot/motion/simulate_walk.hpp"
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
inline void check(const ThresholdOptions& options) {
  const auto fail = [](const char* what, double value) {
    std::ostringstream text;
    text << "ThresholdOptions: " << what << ", got " << value;
    throw MotionError(text.str());
  };
  check(options.alarm);
  const double share = options.false_alarms, confidence = options.confidence;
  if (!(share > 0 && share < 1)) fail("false_alarms must be in (0, 1)", share);
  if (!(confidence > 0 && confidence < 1)) fail("confidence must be in (0, 1)", confidence);
  if (options.run_length < 1) fail("run_length must be at least 1", options.run_length);
  if (!(options.noise_error >= 0 && std::isfinite(options.noise_error))) {
    fail("noise_error must be a finite number from 0 on", options.noise_error);
  }
  const double needed = std::ceil(std::log(1 - confidence) / std::log(1 - share));
  if (options.runs < needed) fail(("runs must be at least " + std::to_string(int(needed))).c_str(), options.runs);
}

namespace detail {

/// The largest m for which at least m of `runs` events of probability `share` happen with this confidence: the m-th
/// largest of as many draws is above the quantile 1 - share that surely. 0 if there is none.
inline int safe_rank(int runs, double share, double confidence) {
  double term = std::pow(1 - share, runs), sum = 0;  // of exactly m events, of less than m
  for (int m = 0;; ++m) {
    if (sum > 1 - confidence || m > runs) return m - 1;
    sum += term;
    term *= (runs - m) * share / ((m + 1) * (1 - share));
  }
}

}  // namespace detail

/// The threshold [nats] for an alarm that starts from this tracker, for sequences with the commands and measured poses of
/// `like` (drawn with replacement). In each run the robot's parameters are drawn from what the calibration knows of
/// them. The same for every executor. Throws MotionError for options that fail the check and sequences that cannot be
/// used.
template <MotionModel M, Executor E>
double alarm_threshold(const MotionTracker<M>& calibrated, std::span<const WalkSequence> like,
                       const ThresholdOptions& options, const E& executor, std::uint64_t seed) {
  constexpr int n = M::parameter_count;
  check(options);
  check(like);
  const Eigen::LLT<typename MotionTracker<M>::Square> root(calibrated.covariance());
  const auto job = [&](std::size_t run) {
    Rng rng(seed, run);
    Vec<n> unit;
    for (int i = 0; i < n; ++i) unit[i] = rng.normal();
    const M robot = M::from_parameters(calibrated.model.parameters() + root.matrixL() * unit);
    MotionNoise noise = calibrated.noise;
    Vec<3> factor;
    for (int i = 0; i < 3; ++i) factor[i] = std::exp(options.noise_error * rng.normal());
    for (Vec<3>* part : {&noise.constant, &noise.per_speed, &noise.per_acceleration}) {
      *part = part->cwiseProduct(factor).eval();
    }
    ChangeAlarm<M> alarm{
        .tracker = calibrated, .threshold = std::numeric_limits<double>::infinity(), .options = options.alarm};
    double most = 0;
    for (int i = 0; i < options.run_length; ++i) {
      const WalkSequence& drawn = like[rng.below(static_cast<std::uint32_t>(like.size()))];
      const WalkSequence walked = simulate_walk(robot, noise, calibrated.accuracy, drawn, rng);
      most = std::max(most, update(alarm, walked).evidence);
    }
    return most;
  };
  std::vector<double> most = map(executor, static_cast<std::size_t>(options.runs), job);
  std::sort(most.begin(), most.end(), std::greater<>());
  const int rank = detail::safe_rank(options.runs, options.false_alarms, options.confidence);
  return most[static_cast<std::size_t>(rank - 1)];
}

}  // namespace surefoot
