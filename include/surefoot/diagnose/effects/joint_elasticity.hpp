// A flexible joint: a second inertia, `ratio` times the first, behind a spring and a damper (see two_masses.hpp).
// M. W. Spong: "Modeling and control of elastic joint robots", J. Dyn. Sys. Meas. Control 109, 1987.
// Confusable with a larger inertia (slow motions), with a lag of the input, and with backlash, which gives way too.
#pragma once

#include "surefoot/diagnose/effect.hpp"
#include "surefoot/diagnose/effects/two_masses.hpp"

namespace surefoot::effects {

namespace detail {

inline TwoMasses elastic_joint(Values p) { return TwoMasses{.ratio = p[0], .frequency = p[1], .damping = p[2]}; }

}  // namespace detail

inline Effect joint_elasticity() {
  return {.name = "joint_elasticity",
          .sentence = "an elastic joint with {ratio} times the inertia behind it, swinging at {frequency}, at {at}",
          .place = Place::velocity,
          .parameters = {{.name = "ratio", .measure = {}, .low = 0, .high = 10, .starts = {0.01}, .strength = true},
                         {.name = "frequency",  // of the two against each other [rad/s]
                          .measure = {.time = -1},
                          .low = 5,
                          .high = 200,
                          .starts = {10, 16, 25, 40, 65, 110}},
                         {.name = "damping",  // share of the critical one
                          .measure = {},
                          .low = 0.01,
                          .high = 1,
                          .starts = {0.1}}},
          .confusable_with = {"backlash", "first_order_lag", "input_delay"},
          .experiment = "a chirp over the suspected frequency, and sharp stops with the ringing recorded",
          .memories = 3,
          .force = [](const Moment& m, Values p,
                      Values memory) { return detail::force_of(detail::elastic_joint(p), m, memory); },
          .start = [](const Moment& m, Values, Memory memory) { detail::start(m, memory); },
          .advance = [](const Moment& m, Values p,
                        Memory memory) { detail::advance(detail::elastic_joint(p), m, memory); }};
}

}  // namespace surefoot::effects
