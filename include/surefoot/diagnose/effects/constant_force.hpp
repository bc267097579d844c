// A force that never changes: tilt, a preloaded spring, a cable that pulls.
// Confusable with a bias of the sensor or of the input, and with gravity on a joint that keeps to a small range.
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect constant_force() {
  return {.name = "constant_force",
          .sentence = "a constant force of {force} at {at}",
          .place = Place::velocity,
          .parameters = parameters_of({{.name = "force",
                                        .measure = {.effort = 1},
                                        .low = -10,  // what holds a weight may be many times what moves it
                                        .high = 10,
                                        .starts = {0.003, 0.1},
                                        .strength = true}}),
          .confusable_with = names_of({"gravity_offset", "sensor_bias", "input_asymmetry"}),
          .experiment = "hold several positions far apart, each reached from both sides",
          .is_constant = true,
          .force = +[](const EffectContext&, Values p, Values) { return p[0]; }};
}

}  // namespace surefoot::effects
