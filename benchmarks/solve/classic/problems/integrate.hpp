// One step of the classical Runge-Kutta method, with the action held.
#pragma once

#include "surefoot/core/vec.hpp"

namespace classic {

/// The state `dt` seconds later; `rates(state)` are its derivatives.
template <int N, class Rates>
surefoot::Vec<N> runge_kutta(const surefoot::Vec<N>& state, double dt, const Rates& rates) {
  const surefoot::Vec<N> a = rates(state);
  const surefoot::Vec<N> b = rates(surefoot::Vec<N>(state + 0.5 * dt * a));
  const surefoot::Vec<N> c = rates(surefoot::Vec<N>(state + 0.5 * dt * b));
  const surefoot::Vec<N> d = rates(surefoot::Vec<N>(state + dt * c));
  return state + dt / 6 * (a + 2 * b + 2 * c + d);
}

}  // namespace classic
