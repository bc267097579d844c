// Definitions of surefoot/motion/fit/noise_fit.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/motion/fit/noise_fit.hpp"
#include "surefoot/motion/fit/pose_filter.hpp"
#include "surefoot/optimize/cma_es.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot {

SUREFOOT_INLINE std::vector<CycleDeviation> cycle_deviations(const AnyMotionModel& model,
                                                             std::span<const WalkSequence> sequences) {
  std::vector<CycleDeviation> result;
  for (const WalkSequence& sequence : sequences) {
    const Eigen::Matrix3Xd displacements = model.displacements(sequence.commands, sequence.command_before);
    for (Eigen::Index cycle = 0; cycle < sequence.cycles(); ++cycle) {
      const auto known = [&](Eigen::Index i) { return sequence.position_measured(i) && sequence.heading_measured(i); };
      if (!known(cycle) || (cycle > 0 && !known(cycle - 1))) continue;
      const Pose2 from = cycle == 0 ? Pose2{} : Pose2::from_vec(sequence.poses.col(cycle - 1));
      const Vec<3> command = sequence.commands.col(cycle), previous = sequence.previous_command(cycle);
      const Vec<3> really = (from.inverse() * Pose2::from_vec(sequence.poses.col(cycle))).vec();
      Vec<3> value = really - displacements.col(cycle);
      value[2] = wrap_angle(value[2]);
      result.push_back({command, previous, value});
    }
  }
  return result;
}

SUREFOOT_INLINE bool sees_single_cycles(std::span<const WalkSequence> sequences) {
  Eigen::Index cycles = 0, seen = 0;
  for (const WalkSequence& sequence : sequences) {
    cycles += sequence.cycles();
    for (Eigen::Index cycle = 0; cycle < sequence.cycles(); ++cycle) {
      if (sequence.position_measured(cycle) && sequence.heading_measured(cycle)) ++seen;
    }
  }
  return 2 * seen > cycles;
}

}  // namespace surefoot

namespace surefoot::detail {

/// log(erfc(z)), to 1e-5, also where erfc is less than any double: asymptotic series (Abramowitz & Stegun 7.1.23).
SUREFOOT_INLINE double log_erfc(double z) {
  return z < 20 ? std::log(std::erfc(z)) : -z * z - std::log(z * std::sqrt(std::numbers::pi)) - 0.5 / (z * z);
}

SUREFOOT_INLINE Eigen::ArrayXd ComponentDeviations::log_density(NoiseShape shape, const Eigen::VectorXd& growth) const {
  const auto sigma = [&](Eigen::Index i) { return growth[0] + growth[1] * speed[i] + growth[2] * acceleration[i]; };
  const double blur2 = std::max(blur * blur, 1e-20);
  if (shape == NoiseShape::gaussian) {
    Eigen::ArrayXd log = size;
    for (Eigen::Index i = 0; i < size.size(); ++i) log[i] = 2 * std::numbers::pi * (sigma(i) * sigma(i) + blur2);
    log = log.log();  // by twos: not always std::log() to the last bit
    for (Eigen::Index i = 0; i < size.size(); ++i) {
      log[i] = -0.5 * (size[i] * size[i] / (sigma(i) * sigma(i) + blur2) + log[i]);
    }
    return log;
  }
  // Uniform and normal noise added up; at its edge the density falls as the normal one does.
  const double s = std::sqrt(blur2);
  Eigen::ArrayXd result(size.size());
  for (Eigen::Index i = 0; i < size.size(); ++i) {
    const double half = std::numbers::sqrt3 * sigma(i);
    if (half < 1e-3 * s) {
      result[i] = -0.5 * size[i] * size[i] / blur2 - std::log(s * std::sqrt(2 * std::numbers::pi));
    } else {
      const double out = log_erfc((size[i] - half) / (s * std::numbers::sqrt2)),
                   in = log_erfc((size[i] + half) / (s * std::numbers::sqrt2));
      result[i] = out + std::log1p(-std::exp(in - out)) - std::log(4 * half);
    }
  }
  return result;
}

SUREFOOT_INLINE double mean_of_squares(const Eigen::ArrayXd& values) {
  return dot(values.data(), values.data(), values.size()) / static_cast<double>(values.size());
}

SUREFOOT_INLINE ComponentDeviations component(std::span<const CycleDeviation> cycles, Eigen::Index axis,
                                              const PoseAccuracy& accuracy, const MotionNoise& scales, int parameters) {
  const auto count = static_cast<Eigen::Index>(cycles.size());
  ComponentDeviations result{Eigen::ArrayXd(count), Eigen::ArrayXd(count), Eigen::ArrayXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const CycleDeviation& cycle = cycles[static_cast<std::size_t>(i)];
    result.size[i] = std::abs(cycle.value[axis]);
    result.speed[i] = scales.speed(cycle.commands);
    result.acceleration[i] = scales.acceleration(cycle.commands, cycle.previous);
  }
  // Both ends of a cycle are measured; the model is known as well as `parameters` shared by three components allow.
  const double mean_square = mean_of_squares(result.size);
  result.blur = std::sqrt(2 * accuracy.variance()[axis] +
                          mean_square * std::min(1.0, parameters / 3.0 / static_cast<double>(count)));
  return result;
}

SUREFOOT_INLINE std::array<bool, 3> free_terms(NoiseGrowth growth) {
  return {growth != NoiseGrowth::with_speed, growth != NoiseGrowth::constant,
          growth == NoiseGrowth::with_speed_and_acceleration};
}

SUREFOOT_INLINE void set_free_terms(MotionNoise& noise, NoiseGrowth growth, Eigen::Index axis,
                                    const Eigen::VectorXd& terms) {
  const std::array<bool, 3> free = free_terms(growth);
  Eigen::Index next = 0;
  noise.constant[axis] = free[0] ? terms[next++] : 0;
  noise.per_speed[axis] = free[1] ? terms[next++] : 0;
  noise.per_acceleration[axis] = free[2] ? terms[next++] : 0;
}

}  // namespace surefoot::detail

namespace surefoot {

SUREFOOT_INLINE Eigen::ArrayXd cycle_log_densities(const MotionNoise& noise, std::span<const CycleDeviation> cycles,
                                                   const PoseAccuracy& accuracy, int parameters) {
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(cycles.size()));
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    sum += detail::component(cycles, axis, accuracy, noise, parameters)
               .log_density(noise.shape,
                            Vec<3>(noise.constant[axis], noise.per_speed[axis], noise.per_acceleration[axis]));
  }
  return sum;
}

SUREFOOT_INLINE MotionNoise fit_cycle_noise(std::span<const CycleDeviation> cycles, NoiseShape shape,
                                            NoiseGrowth growth, const NoiseFitOptions& options, int parameters) {
  MotionNoise noise{.shape = shape, .scale = options.scale};
  const Eigen::Index free = detail::count_free_terms(growth);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const detail::ComponentDeviations data = detail::component(cycles, axis, options.accuracy, noise, parameters);
    const double typical = std::max(std::sqrt(detail::mean_of_squares(data.size)), 1e-9);
    const auto cost = [&](const Eigen::VectorXd& terms) {
      MotionNoise candidate;
      detail::set_free_terms(candidate, growth, axis, detail::times(typical, terms));
      return -data.log_density(shape, Vec<3>(candidate.constant[axis], candidate.per_speed[axis],
                                             candidate.per_acceleration[axis]))
                  .mean();
    };
    CmaEsOptions search{.box_sigma = 0.1, .max_evaluations = 2000};
    search.tolerances.fun = 1e-7;
    search.tolerances.x = 1e-4;
    const Box<Eigen::Dynamic> box(Eigen::VectorXd::Zero(free), Eigen::VectorXd::Constant(free, 8));
    const CmaEsResult found =
        cma_es(cost, Eigen::VectorXd::Constant(free, 1.2 / static_cast<double>(free)), box, search, Serial{}, 1);
    detail::set_free_terms(noise, growth, axis, detail::times(typical, found.best));
  }
  return noise;
}

SUREFOOT_INLINE MotionNoise fit_pose_noise(const AnyMotionModel& model, std::span<const WalkSequence> sequences,
                                           NoiseGrowth growth, const NoiseFitOptions& options, const Vec<3>& start) {
  const Eigen::Index free = detail::count_free_terms(growth);
  const auto noise_of = [&](const Eigen::VectorXd& terms) {  // logarithms, in units of `start`
    MotionNoise noise{.shape = NoiseShape::gaussian, .scale = options.scale};
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Eigen::ArrayXd part(free);
      for (Eigen::Index i = 0; i < free; ++i) part[i] = terms[axis * free + i];
      part = part.exp();  // by twos: not always std::exp() to the last bit
      detail::set_free_terms(noise, growth, axis, detail::times(start[axis], part.matrix()));
    }
    return noise;
  };
  const std::vector<Eigen::Matrix3Xd> displacements = detail::displacements(model, sequences);
  const auto cost = [&](const Eigen::VectorXd& terms) {
    // What the poses do not tell stays near the first guess: by a factor of e or so.
    return -detail::log_likelihood(displacements, noise_of(terms), options.accuracy, sequences) +
           0.5 * detail::dot(terms.data(), terms.data(), terms.size());
  };
  CmaEsOptions search{.max_evaluations = 3000};
  search.tolerances.fun = 1e-4;
  search.tolerances.x = 1e-3;
  return noise_of(cma_es(cost, Eigen::VectorXd::Zero(3 * free), 1.0, search, Serial{}, 1).best);
}

SUREFOOT_ONCE void check(const NoiseFitOptions& options) {
  check(options.accuracy);
  if (!(options.scale.minCoeff() > 0 && all_finite(options.scale))) {
    throw MotionError("NoiseFitOptions: scale must be finite and above 0 in every component");
  }
}

}  // namespace surefoot
