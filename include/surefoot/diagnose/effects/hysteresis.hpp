// Hysteresis: a force that depends on the way and not on the speed, as of rubber, cables and pre-sliding friction.
// R. Bouc, 1967; Y.-K. Wen: "Method for random vibration of hysteretic systems", J. Eng. Mech. 102, 1976:
//   z' = v - |v| z / width  (exponent 1, beta alone),   force = -force * z / width.
// Form "n = 2" has exponent 2 and beta = gamma: dz/dq = 1 - (z/width)^2 on the way up, 1 on the way back. Form
// "asymmetric" has exponent 1 and any gamma: dz/dq = 1 - (1 - shape) |z|/width on the way out, 1 + (1 + shape)
// |z|/width on the way back, with shape = -gamma / beta; beyond 1 it stiffens on the way out. These are functions of
// the distance travelled since the last step, evaluated in closed form and stable for any step. Form "any exponent" has
// dz/dq = 1 - (|z|/width)^exponent on the way out, 1 + back (|z|/width)^exponent on the way back, and is integrated.
// HiddenStates: z, position after the last step. With a width far below the travel it is dry friction that is reached
// after some presliding (P. R. Dahl, 1968), and called so; confusable with backlash, which also forgets the way at each
// reversal.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "surefoot/diagnose/effects/coulomb_friction.hpp"
#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"
#include "surefoot/diagnose/effects/smooth_friction.hpp"

namespace surefoot::effects {

/// z after moving by `way` from z. |result| <= width if |z| was.
inline double bouc_wen_1(double z, double way, double width) {
  const double limit = way < 0 ? -width : width;
  return limit + (z - limit) * std::exp(-std::abs(way) / width);
}

inline double bouc_wen_2(double z, double way, double width) {
  const double side = way < 0 ? -1 : 1;
  double up = side * z, left = std::abs(way);  // seen in the direction of motion
  if (up < 0) {                                // unloading: a plain spring
    const double share = std::min(left, -up);
    up += share;
    left -= share;
  }
  const double a = std::min(up / width, 1.0), b = std::tanh(left / width);
  return side * width * (a + b) / (1 + a * b);  // addition theorem of tanh
}

/// Falloff per width below which a path is straight: what it bends is rounding.
inline constexpr double straight_path = 1e-6;

/// After `way` along dz/dq = 1 - falloff * z, from z on.
inline double exponential_path(double z, double way, double falloff) {
  if (std::abs(falloff) < straight_path) return z + way;
  return z * std::exp(-falloff * way) - std::expm1(-falloff * way) / falloff;
}

inline double bouc_wen_asymmetric(double z, double way, double width, double shape) {
  const double side = way < 0 ? -1 : 1, back = 1 + shape;
  double up = side * z / width, left = std::abs(way) / width;  // seen in the direction of motion
  if (up < 0) {
    const double slope = 1 - back * up;  // at least 0 unless it stiffens on the way back, too
    const double to_zero = std::abs(back) < straight_path ? -up : slope > 0 ? std::log(slope) / back : left;
    const double share = std::min(left, to_zero);
    up = share < to_zero ? exponential_path(up, share, back) : 0;
    left -= share;
  }
  return side * width * exponential_path(up, left, 1 - shape);
}

/// Share of the typical travel up to which a width is that of presliding.
inline constexpr double presliding_width = 0.05;

/// Travel after which a friction with presliding has about two thirds of its level.
inline EffectParameter presliding_width_parameter(std::vector<double> starts) {
  return {
      .name = "width", .measure = {.position = 1}, .low = 1e-4, .high = presliding_width, .starts = std::move(starts)};
}

/// With any exponent and beta + gamma = 1, by Runge-Kutta steps of at most a tenth of the width. `back` is beta -
/// gamma: by how much it is steeper on the way back. Cost: ten steps per width of way.
inline double bouc_wen(double z, double way, double width, double back, double exponent) {
  constexpr double steps_per_width = 10, most_widths = 20;  // of way: then it is at its level
  const double side = way < 0 ? -1 : 1, left = std::min(std::abs(way) / width, most_widths);
  const auto slope = [back, exponent](double up) {
    const double bent = std::pow(std::abs(up), exponent);
    return up < 0 ? 1 + back * bent : 1 - bent;
  };
  const int steps = std::max(1, static_cast<int>(std::ceil(left * steps_per_width)));
  const double h = left / steps;
  double up = side * z / width;  // seen in the direction of motion
  for (int i = 0; i < steps; ++i) {
    const double a = slope(up), b = slope(up + 0.5 * h * a), c = slope(up + 0.5 * h * b), d = slope(up + h * c);
    up += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return side * width * up;
}

/// HiddenStates of a path that begins: z, and the position.
inline void start_of_path(const EffectContext& m, Values /*p*/, HiddenStates hidden) {
  hidden[0] = 0;
  hidden[1] = m.position;
}

/// z between the levels of the force on both sides, `widths` of travel away.
inline void keep_between_levels(HiddenStates hidden, double width, double widths = 1) {
  hidden[0] = std::clamp(hidden[0], -widths * width, widths * width);
}

template <double (*Move)(double, double, double)>
[[gnu::cold]] Effect hysteresis_of(std::string form) {
  return {
      .name = "hysteresis",
      .sentence = "hysteresis of {force}, reached after {width} of travel, at {at}",
      .place = Place::velocity,
      .parameters = parameters_of(
          {{.name = "force", .measure = {.effort = 1}, .low = 0, .high = 3, .starts = {0.003, 0.1}, .strength = true},
           {.name = "width", .measure = {.position = 1}, .low = presliding_width, .high = 2, .starts = {0.1, 0.5}}}),
      .confusable_with = names_of({"coulomb_friction", "backlash", "stribeck_friction"}),
      .experiment = "slow reversals of growing amplitude, from far below to far above the width",
      .form = std::move(form),
      .hidden_states = 2,
      .start_measure = Measure{.position = 1},
      .force = +[](const EffectContext& m, Values p,
                   Values hidden) { return -p[0] * Move(hidden[0], m.position - hidden[1], p[1]) / p[1]; },
      .start = start_of_path,
      .limit_start = +[](Values p, HiddenStates hidden) { keep_between_levels(hidden, p[1]); },
      .advance =
          +[](const EffectContext& m, Values p, HiddenStates hidden) {
            hidden[0] = Move(hidden[0], m.position - hidden[1], p[1]);
            hidden[1] = m.position;
          }};
}

[[gnu::cold]] inline Effect hysteresis() { return hysteresis_of<bouc_wen_1>(""); }

/// Dry friction with presliding.
[[gnu::cold]] inline Effect coulomb_friction_presliding() {
  Effect effect = hysteresis_of<bouc_wen_1>("presliding");
  effect.name = "coulomb_friction";
  effect.sentence = "dry friction of {force}, reached after {width} of presliding, at {at}";
  effect.parameters[1] = presliding_width_parameter({0.005, 0.02});
  effect.confusable_with =
      names_of({"stribeck_friction", "load_dependent_friction", "hysteresis", "viscous_friction", "dead_zone"});
  effect.experiment = "a slow ramp with reversals, at a few speeds down to the slowest that still moves";
  return effect;
}

/// A dry friction that is reached after some travel, in a form of its own: after a reversal it has the share of its
/// level that the hysteresis of exponent 1 has of its force.
[[gnu::cold]] inline Effect with_presliding(Effect friction) {
  friction.sentence += ", reached after {width} of presliding";
  friction.parameters[0].starts = {0.1};
  const std::size_t width = friction.parameters.size();
  friction.parameters.push_back(presliding_width_parameter({0.01}));
  friction.form += friction.form.empty() ? "presliding" : ", presliding";
  for (std::string& form : friction.extends) form += ", presliding";
  friction.hidden_states = 2;
  friction.start_measure = Measure{.position = 1};
  friction.force = [level = std::exchange(friction.dry, {}), width](const EffectContext& m, Values p, Values hidden) {
    return -level(m, p) * bouc_wen_1(hidden[0], m.position - hidden[1], p[width]) / p[width];
  };
  friction.start = start_of_path;
  friction.limit_start = [width](Values p, HiddenStates hidden) { keep_between_levels(hidden, p[width]); };
  friction.advance = [width](const EffectContext& m, Values p, HiddenStates hidden) {
    hidden[0] = bouc_wen_1(hidden[0], m.position - hidden[1], p[width]);
    hidden[1] = m.position;
  };
  return friction;
}

/// A friction with presliding whose bristles are damped, where a form of `plain` was found: the model of C. Canudas de
/// Wit, H. Olsson, K. J. Astrom, P. Lischinsky, "A new model for control of systems with friction", IEEE Trans.
/// Automatic Control 40(3), 1995, with the quotient of its damping and stiffness as a time. Bristles that are not
/// damped may leave more than none at all.
[[gnu::cold]] inline Effect damped(Effect effect, const Effect& plain) {
  effect.sentence += ", damped over {damping_time}";
  effect.extends = {plain.form, smoothed(plain).form, effect.form};
  effect.form += ", damped";
  const std::size_t width = effect.parameters.size() - 1;
  effect.parameters.push_back(
      {.name = "damping_time", .measure = {.time = 1}, .low = 0, .high = 0.05, .starts = {0.001, 0.005}});
  effect.force = [level = plain.dry, width](const EffectContext& m, Values p, Values hidden) {
    const double share = bouc_wen_1(hidden[0], m.position - hidden[1], p[width]) / p[width];
    const double rate = (m.value - std::abs(m.value) * share) / p[width];
    return -level(m, p) * (share + p[width + 1] * rate);
  };
  return effect;
}

[[gnu::cold]] inline Effect coulomb_friction_damped() {
  return damped(coulomb_friction_presliding(), coulomb_friction());
}

[[gnu::cold]] inline Effect hysteresis_asymmetric() {
  Effect effect = hysteresis();
  effect.sentence = "hysteresis of {force} and shape {shape}, reached after {width} of travel, at {at}";
  effect.parameters[0].starts = {0.1};
  effect.parameters.push_back({.name = "shape", .low = -2, .high = 2, .starts = {-0.7, 1.2}});
  effect.form = "asymmetric";
  effect.limit_start = +[](Values p, HiddenStates hidden) {
    constexpr double stiffening = 10;  // widths, where it has no level
    keep_between_levels(hidden, p[1], p[2] < 1 - 1 / stiffening ? 1 / (1 - p[2]) : stiffening);
  };
  effect.force = +[](const EffectContext& m, Values p, Values hidden) {
    return -p[0] * bouc_wen_asymmetric(hidden[0], m.position - hidden[1], p[1], p[2]) / p[1];
  };
  effect.advance = +[](const EffectContext& m, Values p, HiddenStates hidden) {
    hidden[0] = bouc_wen_asymmetric(hidden[0], m.position - hidden[1], p[1], p[2]);
    hidden[1] = m.position;
  };
  return effect;
}

/// The exponent says how sharply the force turns from rising to its level.
[[gnu::cold]] inline Effect hysteresis_general() {
  Effect effect = hysteresis();
  effect.sentence =
      "hysteresis of {force} and exponent {exponent}, {back} steeper on the way back, reached after {width} of travel, "
      "at {at}";
  effect.parameters.push_back({.name = "back", .low = -1, .high = 2, .starts = {0, 1}});
  effect.parameters.push_back({.name = "exponent", .low = 0.5, .high = 6, .starts = {1, 2}});
  effect.form = "any exponent";
  effect.extends = {"", "n = 2"};
  effect.force = +[](const EffectContext& m, Values p, Values hidden) {
    return -p[0] * bouc_wen(hidden[0], m.position - hidden[1], p[1], p[2], p[3]) / p[1];
  };
  effect.advance = +[](const EffectContext& m, Values p, HiddenStates hidden) {
    hidden[0] = bouc_wen(hidden[0], m.position - hidden[1], p[1], p[2], p[3]);
    hidden[1] = m.position;
  };
  return effect;
}

[[gnu::cold]] inline Effect hysteresis_squared() { return hysteresis_of<bouc_wen_2>("n = 2"); }

}  // namespace surefoot::effects
