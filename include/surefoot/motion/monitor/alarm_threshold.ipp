// Definitions of surefoot/motion/monitor/alarm_threshold.hpp.
#pragma once

#include <Eigen/Core>
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

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/motion/monitor/alarm_threshold.hpp"
#include "surefoot/motion/monitor/cholesky.hpp"
#include "surefoot/motion/simulate_walk.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const ThresholdOptions& options) {
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

SUREFOOT_INLINE AlarmSimulation::AlarmSimulation(const MotionTracker& calibrated, std::span<const WalkSequence> like,
                                                 const ThresholdOptions& options, std::uint64_t seed)
    : calibrated_(calibrated), like_(like), options_(options), seed_(seed) {
  check(options);
  check(like);
  root_ = Cholesky(calibrated.covariance()).lower();
}

SUREFOOT_INLINE double AlarmSimulation::run(std::size_t run) const {
  Rng rng(seed_, run);
  Eigen::VectorXd unit(root_.rows());
  for (double& u : unit) u = rng.normal();
  const AnyMotionModel& known = calibrated_.model;
  const AnyMotionModel robot = known.with_parameters(add_lower_product(known.parameters(), root_, unit));
  MotionNoise noise = calibrated_.noise;
  Vec<3> factor;
  for (int i = 0; i < 3; ++i) factor[i] = std::exp(options_.noise_error * rng.normal());
  for (Vec<3>* part : {&noise.constant, &noise.per_speed, &noise.per_acceleration}) {
    for (int i = 0; i < 3; ++i) (*part)[i] *= factor[i];
  }
  ChangeAlarm alarm{
      .tracker = calibrated_, .threshold = std::numeric_limits<double>::infinity(), .options = options_.alarm};
  double most = 0;
  for (int i = 0; i < options_.run_length; ++i) {
    const WalkSequence& drawn = like_[rng.below(static_cast<std::uint32_t>(like_.size()))];
    const WalkSequence walked = simulate_walk(robot, noise, calibrated_.accuracy, drawn, rng);
    most = std::max(most, update(alarm, walked).evidence);
  }
  return most;
}

SUREFOOT_INLINE double AlarmSimulation::threshold(std::vector<double> most) const {
  std::sort(most.begin(), most.end(), std::greater<>());
  const int rank = safe_rank(options_.runs, options_.false_alarms, options_.confidence);
  return most[static_cast<std::size_t>(rank - 1)];
}

SUREFOOT_INLINE int safe_rank(int runs, double share, double confidence) {
  double term = std::pow(1 - share, runs), sum = 0;  // of exactly m events, of less than m
  for (int m = 0;; ++m) {
    if (sum > 1 - confidence || m > runs) return m - 1;
    sum += term;
    term *= (runs - m) * share / ((m + 1) * (1 - share));
  }
}

}  // namespace detail

}  // namespace surefoot
