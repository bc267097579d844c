// Weight off the line that the model assumes: force = weight * cos(q), q the angle of the joint [rad]. The sine part is
// what pendulum models have already.
// Confusable with a constant force on a small range of angles, and with a biased angle sensor.
#pragma once

#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect gravity_offset() {
  return {.name = "gravity_offset",
          .sentence = "weight off the assumed line, {weight} at angle 0, at {at}",
          .place = Place::velocity,
          .parameters = parameters_of({{.name = "weight",
                                        .measure = {.effort = 1},
                                        .low = -3,
                                        .high = 3,
                                        .starts = {0.003, 0.1},
                                        .strength = true}}),
          .confusable_with = names_of({"constant_force", "sensor_bias", "cogging"}),
          .experiment = "hold angles over at least half a turn, each reached from both sides",
          .needs_angle = true,
          .force = +[](const EffectContext& m, Values p, Values) { return p[0] * std::cos(m.position); }};
}

}  // namespace surefoot::effects
