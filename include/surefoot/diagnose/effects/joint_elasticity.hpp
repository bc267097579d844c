// A flexible joint: a second inertia, `ratio` times the first, behind a spring and a damper (see two_masses.hpp).
// M. W. Spong: "Modeling and control of elastic joint robots", J. Dyn. Sys. Meas. Control 109, 1987.
// Confusable with a larger inertia (slow motions), with a lag of the input, and with backlash, which gives way too.
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/detail/two_masses.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

inline TwoMasses elastic_joint(Values p) { return TwoMasses{.ratio = p[0], .frequency = p[1], .damping = p[2]}; }

[[gnu::cold]] inline Effect joint_elasticity() {
  return {
      .name = "joint_elasticity",
      .sentence =
          "an elastic joint with {ratio} times the inertia behind it, swinging at the angular frequency {frequency}, "
          "at {at}",
      .place = Place::velocity,
      .parameters =
          parameters_of({{.name = "ratio", .measure = {}, .low = 0, .high = 10, .starts = {0.01}, .strength = true},
                         {.name = "frequency",  // of the two against each other [rad/s]
                          .measure = {.time = -1},
                          .low = 5,
                          .high = 200,
                          .starts = {10, 16, 25, 40, 65, 110}},
                         {.name = "damping",  // share of the critical one
                          .measure = {},
                          .low = 0.01,
                          .high = 1,
                          .starts = {0.1}}}),
      .confusable_with = names_of({"backlash", "first_order_lag", "input_delay"}),
      .experiment = "a chirp over the suspected frequency, and sharp stops with the ringing recorded",
      .hidden_states = 3,
      .force = +[](const EffectContext& m, Values p, Values hidden) { return force_of(elastic_joint(p), m, hidden); },
      .start = +[](const EffectContext& m, Values, HiddenStates hidden) { start(m, hidden); },
      .advance = +[](const EffectContext& m, Values p, HiddenStates hidden) { advance(elastic_joint(p), m, hidden); }};
}

}  // namespace surefoot::effects
