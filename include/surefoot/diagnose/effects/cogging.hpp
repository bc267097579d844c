// Cogging or torque ripple: a force that repeats along the way,
//   sine * sin(2 pi q/period) + cosine * cos(2 pi q/period),
// and in the form "two harmonics" the same of half the period beside it; in the form "per turn" the period is a share
// of a turn. J. Holtz, L. Springob: "Identification and compensation of torque ripple in high-precision permanent
// magnet motor drives", IEEE Trans. Ind. Electron. 43(2), 1996. Confusable with gravity when the period is about a
// turn, and with stick-slip of Stribeck friction at slow speeds.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect cogging() {
  const EffectParameter amplitude{
      .name = "sine", .measure = {.effort = 1}, .low = -3, .high = 3, .starts = {0.01}, .strength = true};
  EffectParameter quarter_later = amplitude;
  quarter_later.name = "cosine";
  return {.name = "cogging",
          .sentence = "cogging with a period of {period}, amplitudes {sine} and {cosine}, at {at}",
          .place = Place::velocity,
          .parameters = {amplitude,
                         quarter_later,
                         {.name = "period",
                          .measure = {.position = 1},
                          .low = 0.02,
                          .high = 4,  // about the whole travel: what never repeats is no cogging
                          .starts = {0.2, 0.217, 0.235, 0.253, 0.274, 0.3, 0.33, 0.364, 0.41, 0.465, 0.54, 0.645, 0.8,
                                     1.05, 1.5, 2.9}}},
          .confusable_with = names_of({"gravity_offset", "stribeck_friction", "cubic_stiffness"}),
          .experiment = "turn through the whole range slowly and steadily, both ways",
          .force = +[](const EffectContext& m, Values p, Values) {
            const double phase = 2 * std::numbers::pi * m.position / p[2];
            return p[0] * std::sin(phase) + p[1] * std::cos(phase);
          }};
}

/// The same by its number per turn, for an angle that turns round: whole numbers are where it is looked for.
[[gnu::cold]] inline Effect cogging_per_turn() {
  Effect effect = cogging();
  effect.sentence = "cogging of {per_turn} a turn, amplitudes {sine} and {cosine}, at {at}";
  effect.form = "per turn";
  effect.needs_turns = true;
  // slots, poles, teeth, and their common multiples
  effect.parameters[2] = {
      .name = "per_turn", .low = 0.5, .high = 500, .starts = {1,  2,  3,  4,  5,  6,  7,  8,  9,  10,
                                                              11, 12, 13, 14, 15, 16, 18, 20, 21, 22,
                                                              24, 28, 30, 36, 40, 42, 48, 60, 72, 84}};
  effect.force = +[](const EffectContext& m, Values p, Values) {
    return p[0] * std::sin(p[2] * m.position) + p[1] * std::cos(p[2] * m.position);
  };
  return effect;
}

/// Slots and poles repeat with more than one period: the same with half the period beside it.
[[gnu::cold]] inline Effect cogging_harmonics() {
  Effect effect = cogging();
  effect.sentence =
      "cogging with a period of {period}, amplitudes {sine} and {cosine}, and {sine_2} and {cosine_2} of half the "
      "period, at {at}";
  effect.form = "two harmonics";
  effect.extends = {""};
  for (std::size_t k = 0; k < 2; ++k) {
    EffectParameter second = effect.parameters[k];
    second.name += "_2";
    second.starts = {0};
    effect.parameters.push_back(std::move(second));
  }
  effect.force = +[](const EffectContext& m, Values p, Values) {
    const double phase = 2 * std::numbers::pi * m.position / p[2];
    return p[0] * std::sin(phase) + p[1] * std::cos(phase) + p[3] * std::sin(2 * phase) + p[4] * std::cos(2 * phase);
  };
  return effect;
}

}  // namespace surefoot::effects
