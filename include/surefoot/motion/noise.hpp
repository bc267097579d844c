// The noise of a walk: how much each cycle's displacement differs from what the motion model predicts, by chance.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <tuple>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"

namespace surefoot {

/// What a problem asks of noise: a deviation (x, y, turn) [m, m, rad] drawn for a cycle with these commands after one
/// with the commands `previous`.
template <class N>
concept NoiseModel = requires(const N& noise, const Vec<3>& commands, const Vec<3>& previous, Rng& rng) {
  { noise.sample(commands, previous, rng) } -> std::same_as<Vec<3>>;
};

enum class NoiseShape : std::uint8_t { uniform, gaussian };

/// What the standard deviation depends on.
enum class NoiseGrowth : std::uint8_t {
  constant,                     // on nothing
  with_speed,                   // proportional to the speed
  with_speed_and_acceleration,  // linear in speed and acceleration
};

inline std::string_view name_of(NoiseShape shape) { return shape == NoiseShape::uniform ? "uniform" : "gaussian"; }

std::string_view name_of(NoiseGrowth growth);

/// Speed is the length of the commanded displacement and acceleration that of its change since the cycle before, each
/// component counted in units of `scale`. Components (x, y, turn) are independent; the standard deviation of each is
/// constant + per_speed * speed + per_acceleration * acceleration.
struct MotionNoise {
  NoiseShape shape = NoiseShape::gaussian;
  Vec<3> constant = Vec<3>::Zero();          // [m, m, rad]
  Vec<3> per_speed = Vec<3>::Zero();         // [m, m, rad]
  Vec<3> per_acceleration = Vec<3>::Zero();  // [m, m, rad]
  Vec<3> scale{0.08, 0.04, 0.4};             // full commands of a cycle [m, m, rad]
  static constexpr auto fields = std::tuple(&MotionNoise::shape, &MotionNoise::constant, &MotionNoise::per_speed,
                                            &MotionNoise::per_acceleration, &MotionNoise::scale);

  double speed(const Vec<3>& commands) const {
    double squares = 0;
    for (int i = 0; i < 3; ++i) squares += (commands[i] / scale[i]) * (commands[i] / scale[i]);
    return std::sqrt(squares);
  }
  double acceleration(const Vec<3>& commands, const Vec<3>& previous) const { return speed(commands - previous); }

  /// Standard deviations (x, y, turn) [m, m, rad].
  Vec<3> deviation(const Vec<3>& commands, const Vec<3>& previous) const {
    const double fast = speed(commands), jerky = acceleration(commands, previous);
    Vec<3> result;
    for (int i = 0; i < 3; ++i) result[i] = constant[i] + per_speed[i] * fast + per_acceleration[i] * jerky;
    return result;
  }

  Vec<3> sample(const Vec<3>& commands, const Vec<3>& previous, Rng& rng) const {
    const Vec<3> sigma = deviation(commands, previous);
    Vec<3> result;
    for (int i = 0; i < 3; ++i) {
      const double unit = shape == NoiseShape::gaussian ? rng.normal() : std::numbers::sqrt3 * rng.uniform(-1, 1);
      result[i] = sigma[i] * unit;
    }
    return result;
  }
};

static_assert(NoiseModel<MotionNoise>);

/// The same for all commands, uniform between plus and minus these (x, y, turn) [m, m, rad].
struct UniformNoise {
  Vec<3> half_width = Vec<3>::Zero();

  Vec<3> sample(const Vec<3>& /*commands*/, const Vec<3>& /*previous*/, Rng& rng) const {
    Vec<3> result;
    for (int i = 0; i < 3; ++i) result[i] = rng.uniform(-half_width[i], half_width[i]);
    return result;
  }

  /// As the noise that calibration knows.
  MotionNoise as_motion_noise() const {
    return {.shape = NoiseShape::uniform, .constant = half_width / std::numbers::sqrt3};
  }
};

static_assert(NoiseModel<UniformNoise>);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/noise.ipp"
#endif
