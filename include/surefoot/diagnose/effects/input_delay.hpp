// An input that comes late: u(t - delay); delay in seconds, for maps in steps. Form "long": seconds instead of
// hundredths, or whole steps of a map.
// Confusable with a lag (the near twin), with a late sensor, and at one amplitude with backlash.
#pragma once

#include "surefoot/diagnose/effect.hpp"

namespace surefoot::effects {

namespace detail {

inline Effect input_delay_of(std::string form, double high, std::vector<double> starts) {
  return {.name = "input_delay",
          .sentence = "{at} comes {delay} late",
          .place = Place::input,
          .parameters = {{.name = "delay",
                          .measure = {.time = 1},
                          .low = 0,
                          .high = high,
                          .starts = std::move(starts),
                          .strength = true}},
          .confusable_with = {"first_order_lag", "sensor_delay", "backlash", "rate_limit"},
          .experiment =
              "sharp steps of the input at random times: after a delay nothing moves, after a lag it starts at "
              "once",
          .form = std::move(form),
          .delay = [](Values p) { return p[0]; }};
}

}  // namespace detail

inline Effect input_delay() { return detail::input_delay_of("", 0.3, {0.002, 0.01, 0.05}); }

inline Effect input_delay_long() { return detail::input_delay_of("long", 10, {1, 3}); }

}  // namespace surefoot::effects
