// A flexible joint: a second inertia, `ratio` times the first, behind a spring and a damper (see two_masses.hpp).
// M. W. Spong: "Modeling and control of elastic joint robots", J. Dyn. Sys. Meas. Control 109, 1987.
// Form "two modes": another one beside it on the first, as links and their gears have several frequencies.
// Confusable with a larger inertia (slow motions), with a lag of the input, and with backlash, which gives way too.
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/detail/two_masses.hpp"
#include "surefoot/diagnose/effects/detail/two_modes.hpp"
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

inline TwoModes elastic_modes(Values p) {
  return TwoModes{.ratio = {p[0], p[3]}, .frequency = {p[1], p[4]}, .damping = p[2]};
}

[[gnu::cold]] inline Effect joint_elasticity_two_modes() {
  Effect effect = joint_elasticity();
  effect.extends = {effect.form};
  effect.form = "two modes";
  effect.sentence += ", and another with {second_ratio} times the inertia, swinging at {second_frequency}";
  effect.parameters[1].starts = {25};  // it begins at that of the first
  effect.parameters.push_back(
      {.name = "second_ratio", .measure = {}, .low = 0, .high = 10, .starts = {0.1}, .strength = true});
  effect.parameters.push_back({.name = "second_frequency",
                               .measure = {.time = -1},
                               .low = 5,
                               .high = 200,
                               .starts = {10, 16, 25, 40, 65, 110}});
  effect.hidden_states = 5;
  effect.force = +[](const EffectContext& m, Values p, Values hidden) { return force_of(elastic_modes(p), m, hidden); };
  effect.start = +[](const EffectContext& m, Values, HiddenStates hidden) { hidden[4] = m.value; };
  effect.advance = +[](const EffectContext& m, Values p, HiddenStates hidden) { advance(elastic_modes(p), m, hidden); };
  return effect;
}

}  // namespace surefoot::effects
