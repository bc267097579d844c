// An input that acts with a lag: time y' = u - y, y(0) = u(0). The equations get the mean of y over the step. Exact for
// inputs that are held over a step, and stable for any step: with a = 1 - exp(-step/time)
//   y <- y + a (mean u - y),   mean of y = u + (y - u) a time/step.
// Hidden states: y at the end of the last step; integral of u over the present step.
// Form "second order": the filter behind it has a pole more, second * time^2 y'' + time y' = u - y, exact likewise. At
// second = 0 it is the plain form, at 1/4 two equal lags in a row, at 1/2 a Butterworth filter; above 1/4 it
// overshoots. Hidden states: as above, and y' at the end of the last step. K. Ogata: "Modern Control Engineering", 5th
// ed., 2010, section 5.3. Confusable with a delay (the near twin), with a limited rate, and with an elastic joint.
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

/// What is left after a step of a deviation e with second * time^2 e'' + time e' + e = 0.
struct SecondOrderStep {
  double value = 0, rate = 0;  // at its end
  double integral = 0;         // over it
};

inline SecondOrderStep second_order_step(double value, double rate, double step, double time, double second) {
  const double inertia = second * time * time;
  const double decay = time / (2 * inertia), stiffness = 1 / inertia;
  const double apart = decay * decay - stiffness;  // square of half the distance of the poles
  double even = 0, odd = 0;                        // exp(-decay step) times cosh, and sinh over its rate
  if (apart > 0) {
    const double half = std::sqrt(apart);
    const double fast = std::exp(-(decay + half) * step), slow = std::exp(-stiffness / (decay + half) * step);
    even = (slow + fast) / 2;
    odd = half * step > 1e-6 ? (slow - fast) / (2 * half) : step * slow;
  } else {
    const double turns = std::sqrt(-apart) * step, gone = std::exp(-decay * step);
    even = gone * std::cos(turns);
    odd = turns > 1e-6 ? gone * std::sin(turns) * step / turns : step * gone;
  }
  SecondOrderStep end;
  end.value = value * even + (rate + decay * value) * odd;
  end.rate = rate * even - (stiffness * value + decay * rate) * odd;
  end.integral = inertia * (rate - end.rate) + time * (value - end.value);
  return end;
}

[[gnu::cold]] inline Effect second_order_lag() {
  Effect effect = first_order_lag();
  effect.form = "second order";
  effect.extends = names_of({""});
  effect.sentence += ", of second order ({second} of that squared)";
  effect.parameters.push_back(parameters_of({{.name = "second", .low = 0.001, .high = 1, .starts = {0.25}}}).front());
  effect.hidden_states = 3;
  effect.start_measure = {};
  effect.start = +[](const EffectContext& m, Values, HiddenStates hidden) {
    hidden[0] = m.value;
    hidden[1] = hidden[2] = 0;
  };
  effect.hidden_rate = +[](const EffectContext& m, Values, Values, HiddenStates rates) {
    rates[0] = rates[2] = 0;
    rates[1] = m.value;
  };
  effect.advance = +[](const EffectContext& m, Values p, HiddenStates hidden) {
    if (m.step > 0) {
      const double held = hidden[1] / m.step;
      const SecondOrderStep end = second_order_step(hidden[0] - held, hidden[2], m.step, p[0], p[1]);
      hidden[0] = held + end.value;
      hidden[2] = end.rate;
    }
    hidden[1] = 0;
  };
  effect.signal = +[](const EffectContext& m, Values p, Values hidden) {
    if (!(m.step > 0)) return hidden[0];
    return m.value + second_order_step(hidden[0] - m.value, hidden[2], m.step, p[0], p[1]).integral / m.step;
  };
  return effect;
}

}  // namespace surefoot::effects
