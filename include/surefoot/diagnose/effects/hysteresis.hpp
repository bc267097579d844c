// Hysteresis: a force that depends on the way and not on the speed, as of rubber, cables and pre-sliding friction.
// R. Bouc, 1967; Y.-K. Wen: "Method for random vibration of hysteretic systems", J. Eng. Mech. 102, 1976:
//   z' = v - |v| z / width  (exponent 1, beta alone),   force = -force * z / width.
// Form "n = 2" has exponent 2 and beta = gamma: dz/dq = 1 - (z/width)^2 on the way up, 1 on the way back. Both are
// functions of the distance travelled since the last step, so they are evaluated in closed form and stable for any
// step. HiddenStates: z, position after the last step. With a width far below the travel it is dry friction that is
// reached after some presliding (P. R. Dahl, 1968), and called so; confusable with backlash, which also forgets the way
// at each reversal.
#pragma once

#include <algorithm>
#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

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

/// Share of the typical travel up to which a width is that of presliding.
inline constexpr double presliding_width = 0.05;

template <double (*Move)(double, double, double)>
Effect hysteresis_of(std::string form) {
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
      .force = +[](const EffectContext& m, Values p,
                   Values hidden) { return -p[0] * Move(hidden[0], m.position - hidden[1], p[1]) / p[1]; },
      .start =
          +[](const EffectContext& m, Values, HiddenStates hidden) {
            hidden[0] = 0;
            hidden[1] = m.position;
          },
      .advance =
          +[](const EffectContext& m, Values p, HiddenStates hidden) {
            hidden[0] = Move(hidden[0], m.position - hidden[1], p[1]);
            hidden[1] = m.position;
          }};
}

inline Effect hysteresis() { return hysteresis_of<bouc_wen_1>(""); }

/// Dry friction with presliding.
inline Effect coulomb_friction_presliding() {
  Effect effect = hysteresis_of<bouc_wen_1>("presliding");
  effect.name = "coulomb_friction";
  effect.sentence = "dry friction of {force}, reached after {width} of presliding, at {at}";
  effect.parameters[1].low = 0.001;
  effect.parameters[1].high = presliding_width;
  effect.parameters[1].starts = {0.005, 0.02};
  effect.confusable_with =
      names_of({"stribeck_friction", "load_dependent_friction", "hysteresis", "viscous_friction", "dead_zone"});
  effect.experiment = "a slow ramp with reversals, at a few speeds down to the slowest that still moves";
  return effect;
}

inline Effect hysteresis_squared() { return hysteresis_of<bouc_wen_2>("n = 2"); }

}  // namespace surefoot::effects
