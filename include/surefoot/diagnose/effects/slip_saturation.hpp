// Feet that slip: a step gets no further than `level`, d becomes level * tanh(d/level). Forms: "forward", "lateral" [m]
// and "turn" [rad].
// Confusable with a lower gain of that input when all steps are about as large, and with a limit of the input.
#pragma once

#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect slip_saturation_of(double Pose2::*part, std::string form, EffectParameter level) {
  return {.name = "slip_saturation",
          .sentence = "slip: " + form + " steps level off at {level}",
          .place = Place::planar,
          .parameters = {std::move(level)},
          .confusable_with = names_of({"saturation", "input_gain", "supply_sag"}),
          .experiment = "walks of small, medium and the largest " + form + " steps",
          .form = std::move(form),
          .planar = [part](const Pose2& displacement, double, Values p) {
            Pose2 slipped = displacement;
            slipped.*part = p[0] * std::tanh(displacement.*part / p[0]);
            return slipped;
          }};
}

// [m]
inline EffectParameter slip_distance() {
  return {.name = "level", .measure = {.value = 1}, .low = 0.005, .high = 2, .starts = {0.02, 0.05, 0.12, 0.3}};
}

[[gnu::cold]] inline Effect slip_saturation_forward() {
  return slip_saturation_of(&Pose2::x, "forward", slip_distance());
}

[[gnu::cold]] inline Effect slip_saturation_lateral() {
  return slip_saturation_of(&Pose2::y, "lateral", slip_distance());
}

[[gnu::cold]] inline Effect slip_saturation_turn() {
  return slip_saturation_of(
      &Pose2::angle, "turn",
      {.name = "level", .measure = {.position = 1}, .low = 0.02, .high = 3, .starts = {0.1, 0.25, 0.6}});
}

}  // namespace surefoot::effects
