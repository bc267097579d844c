// An input that follows its command by at most `rate` per second (or step): y moves to u by at most rate * step. The
// equations get the mean of y over the step. HiddenStates: y at the end of the last step.
// Confusable with a lag (which is slow for small changes too) and with a delay.
#pragma once

#include <algorithm>
#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect rate_limit() {
  return {.name = "rate_limit",
          .sentence = "{at} changes by {rate} at most",
          .place = Place::input,
          .parameters = parameters_of({{.name = "rate",
                                        .measure = {.value = 1, .time = -1},
                                        .low = 0.02,
                                        .high = 1000,
                                        .starts = {0.3, 1, 3, 10, 40}}}),
          .confusable_with = names_of({"first_order_lag", "input_delay", "saturation"}),
          .experiment = "steps of the input of several sizes: the time to follow grows with the size",
          .hidden_states = 1,
          .start_measure = Measure{.value = 1},
          .start = +[](const EffectContext& m, Values, HiddenStates hidden) { hidden[0] = m.value; },
          .advance =
              +[](const EffectContext& m, Values p, HiddenStates hidden) {
                const double reach = p[0] * m.step;
                hidden[0] += std::clamp(m.value - hidden[0], -reach, reach);
              },
          .signal =
              +[](const EffectContext& m, Values p, Values hidden) {
                const double way = m.value - hidden[0], reach = p[0] * m.step;
                if (reach <= 0) return hidden[0];
                if (std::abs(way) >= reach) return hidden[0] + std::copysign(0.5 * reach, way);
                return m.value - 0.5 * way * std::abs(way) / reach;
              }};
}

}  // namespace surefoot::effects
