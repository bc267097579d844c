// Structure of a simulator, learned by asking it: which state is the speed of which, which output reads which
// state, which signals the inputs drive, which states any rate depends on. And the typical sizes of everything in a set
// of recordings, from which effects take their scales.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <functional>
#include <vector>

#include "surefoot/diagnose/simulator.hpp"

namespace surefoot::diagnosis {

/// How an output reads a state: offset + slope * state, as degrees of an angle in radians.
struct StateReading {
  double offset = 0, slope = 1;

  double state_at(double reading) const { return (reading - offset) / slope; }
  double reading_at(double state) const { return offset + slope * state; }
};

struct SimulatorStructure {
  std::vector<int> position_of;     // by state: the state whose rate it is, or -1
  std::vector<bool> velocity;       // by state: forces may act on it
  std::vector<int> pushed;          // states that a force changes by way of the simulator's response
  std::vector<int> moved_together;  // velocities that one input moves at once, without such a response
  std::vector<bool> affects_rates;  // by state: some rate depends on it (maps are not asked: always)
  std::vector<bool> remembers;      // by state of a map: only keeps inputs, of this step or of earlier ones
  std::vector<int> output_of;       // by state: the output that reads it alone and in proportion, or -1
  std::vector<double> reading_offset, reading_slope;  // by state: how that output does; empty: all as they are
  std::vector<bool> driven_signal;  // by signal: changes with the inputs, at once or by way of an actuator's states
  std::vector<bool> coupling;       // by signal: not driven, and a force on several bodies: what holds them together
  bool all_states_measured = false;  // but for those that only keep inputs, and are known with them
  std::vector<bool> shown_at_once;   // by input: some output reads it in its own row
  std::vector<bool> actuator;        // by state: what inputs lead to, and neither a position nor a speed (a current)
};

/// How the output that reads this state does so.
inline StateReading reading_of(const SimulatorStructure& structure, std::size_t state) {
  if (state >= structure.reading_slope.size()) return {};
  return {structure.reading_offset[state], structure.reading_slope[state]};
}

/// Typical sizes, root mean squares over the recordings.
struct Sizes {
  std::vector<double> state, input, signal, output;
  std::vector<double> rate, effort;                         // by state: from row to row; of rate * effort
  std::vector<double> position;                             // by state: deviation from its mean
  std::vector<double> state_peak, signal_peak;              // largest absolute values
  std::vector<double> input_low, input_high;                // smallest and largest values, or 0
  std::vector<double> least;  // absolute values of inputs, then of signals, other than 0; infinity: none
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

template <class S>
inline constexpr bool has_response = requires(const S& s, const typename S::State& x, const typename S::Input& u,
                                              const Eigen::VectorXd& p) {
  { s.response(x, u, p, x) } -> std::convertible_to<typename S::State>;
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

/// Throws a DiagnoseError unless a vector type of the simulator has room for exactly what info() names.
void check_size(int fixed_size, std::size_t named, const SimulatorInfo& info, const char* type);

/// Answers of a simulator, whatever its type: its rates (or next values), and what it shows.
struct SimulatorAnswers {
  /// Rates. `signals`, where given, gets the values of all signals inside the equations; the one with the number
  /// `larger` is larger by so many small steps (-1: none).
  std::function<Eigen::VectorXd(const Eigen::VectorXd& x, const Eigen::VectorXd& u, std::vector<double>* signals,
                                int larger, int steps)>
      probe;
  /// `otherwise`: of another recording, and with other parameters where they are to be calibrated.
  std::function<Eigen::VectorXd(const Eigen::VectorXd& x, const Eigen::VectorXd& u, bool otherwise)> outputs;
  /// What generalized forces add to the rates; empty: the simulator has no response to them.
  std::function<Eigen::VectorXd(const Eigen::VectorXd& x, const Eigen::VectorXd& u, const Eigen::VectorXd& forces)>
      response;

  Eigen::VectorXd rates(const Eigen::VectorXd& x, const Eigen::VectorXd& u, std::vector<double>* signals) const {
    return probe(x, u, signals, -1, 0);
  }
  Eigen::VectorXd rates_beside(const Eigen::VectorXd& x, const Eigen::VectorXd& u, std::size_t signal,
                               int steps) const {
    return probe(x, u, nullptr, static_cast<int>(signal), steps);
  }
};

/// Notes the values of signals, where given, and makes one larger by some small steps, if any (-1: none).
struct ProbingTap {
  std::vector<double>* signals;
  int larger;
  int steps;
  double operator()(int i, double value) const {
    if (signals != nullptr) (*signals)[static_cast<std::size_t>(i)] = value;
    return i == larger ? value + steps * 1e-3 * (1 + std::abs(value)) : value;
  }
};

/// Parameters that differ from these where they may be calibrated.
Eigen::VectorXd other_parameters(const SimulatorInfo& info, Eigen::VectorXd parameters);

/// The first recording with other constants than the first of all; that one if there is none.
const Recording& with_other_constants(const std::vector<Recording>& recordings);

/// Asks at random points around a recording. Costs some hundred evaluations.
SimulatorStructure find_structure(const SimulatorAnswers& answers, const SimulatorInfo& info, const Recording& example);

/// The same for a simulator as it is for that recording. What an output reads it has to read for `another` one as well.
template <Simulator S>
SimulatorStructure find_structure(const S& simulator, const SimulatorInfo& info, const Recording& example,
                                  const Recording& another, const Eigen::VectorXd& parameters) {
  using State = typename S::State;
  using Input = typename S::Input;
  check_size(State::RowsAtCompileTime, info.states.size(), info, "State");
  check_size(Input::RowsAtCompileTime, info.inputs.size(), info, "Input");
  check_size(S::Output::RowsAtCompileTime, info.outputs.size(), info, "Output");
  S s = for_recording(simulator, example);
  prepare(s, parameters);
  SimulatorAnswers answers;
  answers.probe = [&](const Eigen::VectorXd& x, const Eigen::VectorXd& u, std::vector<double>* signals, int larger,
                      int steps) {
    const ProbingTap tap{signals, larger, steps};
    return converted<Eigen::VectorXd>(State(evaluate(s, converted<State>(x), converted<Input>(u), parameters, tap)));
  };
  const Eigen::VectorXd moved = other_parameters(info, parameters);
  S other = for_recording(simulator, another);
  prepare(other, moved);
  answers.outputs = [&](const Eigen::VectorXd& x, const Eigen::VectorXd& u, bool otherwise) {
    const typename S::Output y =
        (otherwise ? other : s).observe(converted<State>(x), converted<Input>(u), otherwise ? moved : parameters);
    return converted<Eigen::VectorXd>(y);
  };
  if constexpr (has_response<S>) {
    answers.response = [&](const Eigen::VectorXd& x, const Eigen::VectorXd& u, const Eigen::VectorXd& forces) {
      return converted<Eigen::VectorXd>(
          State(s.response(converted<State>(x), converted<Input>(u), parameters, converted<State>(forces))));
    };
  }
  return find_structure(answers, info, example);
}

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/simulation/structure.ipp"
#endif
