// One step of an ODE with effects: Runge-Kutta of order 4 or 2 (midpoint), cut where dry friction stops a velocity.
#pragma once

#include "surefoot/diagnose/simulation/dry_friction.hpp"
#include "surefoot/diagnose/simulation/input_signal.hpp"

namespace surefoot::diagnosis {

template <Simulator S>
void assign(Point<S>& to, const Point<S>& from) {
  assign(to.x, from.x);
  assign(to.z, from.z);
}

template <Simulator S>
Point<S> moved(const Point<S>& from, double h, const Point<S>& rate) {
  return {moved(from.x, h, rate.x), moved(from.z, h, rate.z)};
}

template <Simulator S>
Point<S> moved(const Point<S>& from, double h, const Point<S>& k1, const Point<S>& k2, const Point<S>& k3,
               const Point<S>& k4) {
  return {moved(from.x, h, k1.x, k2.x, k3.x, k4.x), moved(from.z, h, k1.z, k2.z, k3.z, k4.z)};
}

/// rate(at, input, time) of states, or of states and hidden states.
template <class At, class Input, class Rate>
At runge_kutta(const At& at, const InputSignal<Input>& u, int order, double t, double h, Rate&& rate) {
  const Input first = u.between(t, h, 0);
  const At k1 = rate(at, first, t);
  const Input middle = u.steady() ? first : u.between(t, h, 0.5);
  const At k2 = rate(moved(at, 0.5 * h, k1), middle, t + 0.5 * h);
  if (order == 2) return moved(at, h, k2);
  const At k3 = rate(moved(at, 0.5 * h, k2), middle, t + 0.5 * h);
  const At k4 = rate(moved(at, h, k3), u.steady() ? first : u.between(t, h, 1), t + h);
  return moved(at, h, k1, k2, k3, k4);
}

/// Without effects on rates.
template <Simulator S>
void plain_step(const AugmentedSimulator<S>& m, const InputSignal<typename S::Input>& u, int order,
                typename S::State& x, double t, double h) {
  assign(x, runge_kutta(x, u, order, t, h, [&m](const typename S::State& at, const typename S::Input& now, double) {
           return typename S::State(evaluate(m.simulator, at, now, m.p, NoTap{}));
         }));
}

/// With effects on rates and a given mode of each dry friction.
template <Simulator S>
Point<S> effects_step(AugmentedSimulator<S>& m, const InputSignal<typename S::Input>& u, int order, const Point<S>& now,
                      double t, double h, const std::vector<Mode>& modes) {
  using Input = typename S::Input;
  if (m.slots.hidden_rates) {
    return runge_kutta(now, u, order, t, h, [&](const Point<S>& at, const Input& input, double time) {
      Hidden dz = Hidden::Zero(m.slots.hidden);
      const auto rate = rates(m, at.x, at.z, input, dz, time, h, modes);
      return Point<S>{rate, dz};
    });
  }
  Hidden none;
  return {runge_kutta(now.x, u, order, t, h,
                      [&](const typename S::State& x, const Input& input, double time) {
                        return rates(m, x, now.z, input, none, time, h, modes);
                      }),
          now.z};
}

/// `modes` is room for one mode per dry friction.
template <Simulator S>
void step(AugmentedSimulator<S>& m, const InputSignal<typename S::Input>& u, int order, Point<S>& now, double t,
          double h, std::vector<Mode>& modes, int depth = 0) {
  if (m.slots.plain_rates) return plain_step(m, u, order, now.x, t, h);
  const auto slide_for = [&](double length) { return effects_step(m, u, order, now, t, length, modes); };
  if (modes.empty()) {
    assign(now, slide_for(h));
    return;
  }
  decide_modes(m, now, u, t, h, modes);
  Point<S> next = slide_for(h);
  const Stop stop = first_stop(m.slots, modes, now.x, next.x);
  if (stop.at < 0) {
    assign(now, next);
    return;
  }
  if (stop.share > 0) assign(next, slide_for(stop.share * h));
  next.x[stop.at] = 0;
  assign(now, next);
  const double rest = (1 - stop.share) * h;
  if (depth < 4 && rest > 1e-9 * h) step(m, u, order, now, t + stop.share * h, rest, modes, depth + 1);
}

}  // namespace surefoot::diagnosis
