// An input that follows its order by at most `rate` per second (or step): y moves to u by at most rate * step. The
// equations get the mean of y over the step. Memory: y at the end of the last step.
// Confusable with a lag (which is slow for small changes too) and with a delay.
#pragma once

#include <algorithm>
#include <cmath>

#include "surefoot/diagnose/effect.hpp"

namespace surefoot::effects {

inline Effect rate_limit() {
  return {.name = "rate_limit",
          .sentence = "{at} changes by {rate} at most",
          .place = Place::input,
          .parameters = {{.name = "rate",
                          .measure = {.value = 1, .time = -1},
                          .low = 0.02,
                          .high = 1000,
                          .starts = {0.3, 1, 3, 10, 40}}},
          .confusable_with = {"first_order_lag", "input_delay", "saturation"},
          .experiment = "steps of the input of several sizes: the time to follow grows with the size",
          .memories = 1,
          .start = [](const Moment& m, Values, Memory memory) { memory[0] = m.value; },
          .advance =
              [](const Moment& m, Values p, Memory memory) {
                const double reach = p[0] * m.step;
                memory[0] += std::clamp(m.value - memory[0], -reach, reach);
              },
          .signal =
              [](const Moment& m, Values p, Values memory) {
                const double way = m.value - memory[0], reach = p[0] * m.step;
                if (reach <= 0) return memory[0];
                if (std::abs(way) >= reach) return memory[0] + std::copysign(0.5 * reach, way);
                return m.value - 0.5 * way * std::abs(way) / reach;
              }};
}

}  // namespace surefoot::effects
