// Fits of the noise of a walk to what its motion model leaves over, by maximum likelihood. Where poses were measured
// after every cycle each cycle's own deviation is seen, and with it the shape of the noise; final poses are sums over
// many cycles, hence normal whatever the shape, and show its size alone.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// The deviation of one cycle from the model.
struct CycleDeviation {
  Vec<3> commands, previous;  // of the cycle, and of the one before [m, m, rad]
  Vec<3> value;               // in the frame before the cycle (x, y, turn) [m, m, rad]
};

/// Of all cycles whose pose was measured before and after (the start of a sequence is known).
std::vector<CycleDeviation> cycle_deviations(const AnyMotionModel& model, std::span<const WalkSequence> sequences);

/// Whether poses were measured so often that the noise can be read off single cycles.
bool sees_single_cycles(std::span<const WalkSequence> sequences);

namespace detail {

/// One component of the deviations of all cycles, ready to be compared with deviations that grow linearly.
struct ComponentDeviations {
  Eigen::ArrayXd size;                 // |deviation|
  Eigen::ArrayXd speed, acceleration;  // in units of MotionNoise::scale
  double blur = 0;                     // deviation of what is not the walk: measurement, uncertainty of the model

  // By cycle [nats], for noise that grows by (constant, per speed, per acceleration).
  Eigen::ArrayXd log_density(NoiseShape shape, const Eigen::VectorXd& growth) const;
};

ComponentDeviations component(std::span<const CycleDeviation> cycles, Eigen::Index axis, const PoseAccuracy& accuracy,
                              const MotionNoise& scales, int parameters);

/// Which of (constant, per speed, per acceleration) are free.
std::array<bool, 3> free_terms(NoiseGrowth growth);

/// Sets the free terms of all three components from a vector of them: component by component.
void set_free_terms(MotionNoise& noise, NoiseGrowth growth, Eigen::Index axis, const Eigen::VectorXd& terms);

inline Eigen::Index count_free_terms(NoiseGrowth growth) {
  return growth == NoiseGrowth::with_speed_and_acceleration ? 3 : 1;
}

}  // namespace detail

/// How the noise is fitted.
struct NoiseFitOptions {
  PoseAccuracy accuracy = {};
  Vec<3> scale{0.08, 0.04, 0.4};  // commands that count as speed 1 [m, m, rad]
};

/// Throws MotionError, naming the field.
void check(const NoiseFitOptions& options);

/// Log density of each cycle [nats], all components together. `parameters`: how many the motion model has.
Eigen::ArrayXd cycle_log_densities(const MotionNoise& noise, std::span<const CycleDeviation> cycles,
                                   const PoseAccuracy& accuracy, int parameters);

/// Noise of that shape and growth that makes the deviations of single cycles most likely. Components are independent,
/// hence fitted one by one. `parameters`: how many the motion model has.
MotionNoise fit_cycle_noise(std::span<const CycleDeviation> cycles, NoiseShape shape, NoiseGrowth growth,
                            const NoiseFitOptions& options, int parameters);

/// Normal noise of that growth that makes the measured poses most likely, however often they were measured. `start`
/// gives the first guess of its size. Cost: some hundred times all innovations.
MotionNoise fit_pose_noise(const AnyMotionModel& model, std::span<const WalkSequence> sequences, NoiseGrowth growth,
                           const NoiseFitOptions& options, const Vec<3>& start = {0.01, 0.01, 0.05});

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/fit/noise_fit.ipp"
#endif
