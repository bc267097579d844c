// Arithmetic on small vectors, component by component, for the inner loop of simulations.
//
// A position depends on what a speed was a stage ago, so that two stages of a step can be computed side by side. Not
// so if both are kept in one packet, by Eigen or by the compiler: then each stage waits for all of the one before,
// which doubles the time of a step. Hence the loops, and the barriers to the compiler (no instructions) in them.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cmath>

namespace surefoot::diagnosis {

/// A vector of n components without values.
template <class V>
inline V unset(Eigen::Index n) {
  if constexpr (V::RowsAtCompileTime == Eigen::Dynamic) {
    return V(n);
  } else {
    return V();
  }
}

/// Sets each component to value(i), by itself.
template <class V, class Value>
inline void set_each(V& vector, Value&& value) {
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    vector[i] = value(i);
    std::atomic_signal_fence(std::memory_order_seq_cst);
  }
}

template <class V>
inline void assign(V& to, const V& from) {
  set_each(to, [&](Eigen::Index i) { return from[i]; });
}

template <class V>
inline V copied(const V& from) {
  V result = unset<V>(from.size());
  assign(result, from);
  return result;
}

/// Adds `value` to component `at`, in a way that lets the vector stay in registers.
template <class V>
inline void add_at(V& vector, Eigen::Index at, double value) {
  for (Eigen::Index i = 0; i < vector.size(); ++i) vector[i] += i == at ? value : 0.0;
}

/// from + h * rate
template <class V>
inline V moved(const V& from, double h, const V& rate) {
  V result = unset<V>(from.size());
  set_each(result, [&](Eigen::Index i) { return from[i] + h * rate[i]; });
  return result;
}

/// from + h * (mean of the four stages of Runge and Kutta)
template <class V>
inline V moved(const V& from, double h, const V& k1, const V& k2, const V& k3, const V& k4) {
  V result = unset<V>(from.size());
  set_each(result, [&](Eigen::Index i) { return from[i] + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]); });
  return result;
}

template <class V>
inline void write(const V& from, Eigen::MatrixXd& to, Eigen::Index column) {
  for (Eigen::Index i = 0; i < from.size(); ++i) to(i, column) = from[i];
}

template <class V>
inline bool all_finite(const V& vector) {
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    if (!std::isfinite(vector[i])) return false;
  }
  return true;
}

}  // namespace surefoot::diagnosis
