// Structure of a simulator, learned by asking it: which state is the speed of which, which output reads which
// state, which signals the inputs drive, which states any rate depends on. And the typical sizes of everything in a set
// of recordings, from which effects take their scales.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace surefoot::diagnosis {

struct SimulatorStructure {
  std::vector<int> position_of;     // by state: the state whose rate it is, or -1
  std::vector<bool> velocity;       // by state: forces may act on it
  std::vector<bool> matters;        // by state: some rate depends on it (maps are not asked: always)
  std::vector<int> output_of;       // by state: the output that reads it directly, or -1
  std::vector<bool> driven_signal;  // by signal: changes with the inputs
  bool all_states_measured = false;
};

/// Typical sizes, root mean squares over the recordings.
struct Sizes {
  std::vector<double> state, input, signal, output;
  std::vector<double> rate, effort;                         // by state: from row to row; of rate * effort
  std::vector<double> position;                             // by state: deviation from its mean
  std::vector<double> state_peak, input_peak, signal_peak;  // largest absolute values
  double time = 1;                                          // of 200 rows [s], or steps
};

/// All sizes 1: where nothing has been simulated yet.
Sizes unit_sizes(const SimulatorInfo& info);

template <class S>
inline constexpr bool is_ode = requires(const S& s, const typename S::State& x, const typename S::Input& u,
                                        const Eigen::VectorXd& p) {
  s.derivative(x, u, p);
};

template <class S>
inline constexpr bool has_tap = requires(const S& s, const typename S::State& x, const typename S::Input& u,
                                         const Eigen::VectorXd& p) {
  s.derivative(x, u, p, NoTap{});
}
|| requires(const S& s, const typename S::State& x, const typename S::Input& u, const Eigen::VectorXd& p) {
  s.next(x, u, p, NoTap{});
};

/// Rates or next values, with a tap where the simulator has one.
template <class S, class Tap>
typename S::State evaluate(const S& s, const typename S::State& x, const typename S::Input& u, const Eigen::VectorXd& p,
                           Tap&& tap) {
  if constexpr (is_ode<S>) {
    if constexpr (has_tap<S>) {
      return s.derivative(x, u, p, tap);
    } else {
      return s.derivative(x, u, p);
    }
  } else {
    if constexpr (has_tap<S>) {
      return s.next(x, u, p, tap);
    } else {
      return s.next(x, u, p);
    }
  }
}

template <class S>
void prepare(S& s, const Eigen::VectorXd& p) {
  if constexpr (requires { s.prepare(p); }) s.prepare(p);
}

template <class S>
S for_recording(const S& s, const Recording& recording) {
  if constexpr (requires { s.for_recording(recording); }) {
    return s.for_recording(recording);
  } else {
    return s;
  }
}

template <class V>
V sized(Eigen::Index n) {
  if constexpr (V::RowsAtCompileTime == Eigen::Dynamic) {
    return V::Zero(n);
  } else {
    return V::Zero();
  }
}

template <class V, class Source>
V converted(const Source& source) {
  V result = sized<V>(source.size());
  for (Eigen::Index i = 0; i < source.size(); ++i) result[i] = source[i];
  return result;
}

inline bool close(double a, double b) { return std::abs(a - b) <= 1e-9 * (1 + std::abs(a) + std::abs(b)); }

/// Asks the simulator at random points around its recordings. Costs some hundred evaluations.
template <Simulator S>
SimulatorStructure find_structure(const S& simulator, const SimulatorInfo& info, const Recording& example,
                                  const Eigen::VectorXd& parameters) {
  const auto n = info.states.size(), m = info.inputs.size(), k = info.outputs.size();
  S s = for_recording(simulator, example);
  prepare(s, parameters);
  SimulatorStructure structure;
  structure.driven_signal.assign(info.signals.size(), false);
  structure.matters.assign(n, info.kind == SimulatorKind::map);
  std::vector<std::vector<bool>> speed(n, std::vector<bool>(n, true)), reads(n, std::vector<bool>(k, true));
  Rng rng(1);
  std::vector<double> seen(info.signals.size());
  const auto record = [&seen](int i, double value) {
    seen[static_cast<std::size_t>(i)] = value;
    return value;
  };
  constexpr std::array<double, 3> scales{1e-3, 0.1, 1};  // so that signals are met within their limits, too
  for (int round = 0; round < 36; ++round) {
    const double scale = scales[static_cast<std::size_t>(round) % scales.size()];
    auto x = sized<typename S::State>(static_cast<Eigen::Index>(n));
    auto u = sized<typename S::Input>(static_cast<Eigen::Index>(m));
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = example.initial[i] + scale * (0.2 + rng.uniform());
    if (example.rows() > 0 && m > 0) {
      const auto row = static_cast<Eigen::Index>(rng.uniform() * static_cast<double>(example.rows()));
      u = converted<typename S::Input>(example.inputs.col(row));
    }
    const auto rate = evaluate(s, x, u, parameters, record);
    const std::vector<double> first = seen;
    const auto y = s.observe(x, u, parameters);
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      for (std::size_t j = 0; j < n; ++j) {
        if (i == j || !close(rate[row], x[static_cast<Eigen::Index>(j)])) speed[i][j] = false;
      }
      for (std::size_t j = 0; j < k; ++j) {
        if (!close(y[static_cast<Eigen::Index>(j)], x[row])) reads[i][j] = false;
      }
    }
    for (std::size_t i = 0; i < n && info.kind == SimulatorKind::ode; ++i) {
      auto moved = x;
      moved[static_cast<Eigen::Index>(i)] += scale * (0.1 + rng.uniform());
      const auto changed = evaluate(s, moved, u, parameters, NoTap{});
      for (std::size_t j = 0; j < n; ++j) {
        const auto row = static_cast<Eigen::Index>(j);
        if (!close(rate[row], changed[row])) structure.matters[i] = true;
      }
    }
    auto other = u;
    const double reach = (round % 2 == 0 ? 10 : -10) * scale;
    for (double& value : other) value += reach * (0.1 + rng.uniform());
    evaluate(s, x, other, parameters, record);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (!close(first[i], seen[i])) structure.driven_signal[i] = true;
    }
  }
  structure.position_of.assign(n, -1);
  structure.velocity.assign(n, false);
  structure.output_of.assign(n, -1);
  structure.all_states_measured = true;
  for (std::size_t i = 0; i < n; ++i) {
    if (info.kind == SimulatorKind::ode) {
      for (std::size_t j = 0; j < n; ++j) {
        if (speed[i][j]) structure.position_of[j] = static_cast<int>(i);
      }
    }
    for (std::size_t j = 0; j < k; ++j) {
      if (reads[i][j]) structure.output_of[i] = static_cast<int>(j);
    }
    structure.all_states_measured = structure.all_states_measured && structure.output_of[i] >= 0;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const StateInfo& state = info.states[i];
    structure.velocity[i] =
        info.kind == SimulatorKind::ode && (structure.position_of[i] >= 0 || !state.effort_unit.empty());
  }
  return structure;
}

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/simulation/structure.ipp"
#endif
