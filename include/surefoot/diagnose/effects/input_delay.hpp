// An input that comes late, or a signal inside the equations: u(t - delay); delay in seconds, for maps in steps.
// Confusable with a lag (the near twin), with a late sensor, and at one amplitude with backlash.
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect input_delay() {
  return {.name = "input_delay",
          .sentence = "{at} comes {delay} late",
          .place = Place::input,
          .parameters = parameters_of({{.name = "delay",
                                        .measure = {.time = 1},
                                        .low = 0,
                                        .high = 0.5,
                                        .starts = {0.002, 0.01, 0.05},
                                        .strength = true}}),
          .confusable_with = names_of({"first_order_lag", "sensor_delay", "backlash", "rate_limit"}),
          .experiment =
              "sharp steps of the input at random times: after a delay nothing moves, after a lag it starts at "
              "once",
          .delay = +[](Values p) { return p[0]; }};
}

}  // namespace surefoot::effects
