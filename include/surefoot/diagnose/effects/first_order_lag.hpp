// An input that acts with a lag: time y' = u - y, y(0) = u(0). The equations get the mean of y over the step. Exact for
// inputs that are held over a step, and stable for any step: with a = 1 - exp(-step/time)
//   y <- y + a (mean u - y),   mean of y = u + (y - u) a time/step.
// Hidden states: y at the end of the last step; integral of u over the present step.
// Confusable with a delay (the near twin), with a limited rate, and with an elastic joint.
#pragma once

#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// 1 - exp(-steps), which all stages of a run, mostly, ask for with the same value.
inline double gone_after(double steps) {
  thread_local double last = 0, gone = 0;
  if (steps != last) {
    last = steps;
    gone = -std::expm1(-steps);
  }
  return gone;
}

[[gnu::cold]] inline Effect first_order_lag() {
  return {.name = "first_order_lag",
          .sentence = "{at} acts with a lag of {time}",
          .place = Place::input,
          .parameters = parameters_of({{.name = "time",
                                        .measure = {.time = 1},
                                        .low = 0.002,
                                        .high = 2,
                                        .starts = {0.003, 0.01, 0.05, 0.25},
                                        .strength = true}}),
          .confusable_with = names_of({"input_delay", "rate_limit", "sensor_delay", "joint_elasticity"}),
          .experiment =
              "sharp steps of the input at random times: after a lag it starts at once, after a delay nothing "
              "moves",
          .hidden_states = 2,
          .start_measure = Measure{.value = 1},
          .start =
              +[](const EffectContext& m, Values, HiddenStates hidden) {
                hidden[0] = m.value;
                hidden[1] = 0;
              },
          .hidden_rate =
              +[](const EffectContext& m, Values, Values, HiddenStates rates) {
                rates[0] = 0;
                rates[1] = m.value;
              },
          .advance =
              +[](const EffectContext& m, Values p, HiddenStates hidden) {
                if (m.step > 0) hidden[0] += gone_after(m.step / p[0]) * (hidden[1] / m.step - hidden[0]);
                hidden[1] = 0;
              },
          .signal =
              +[](const EffectContext& m, Values p, Values hidden) {
                const double steps = m.step / p[0];
                const double still = steps > 1e-9 ? gone_after(steps) / steps : 1.0;
                return m.value + (hidden[0] - m.value) * still;
              }};
}

}  // namespace surefoot::effects
