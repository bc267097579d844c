// The concept of a Markov decision process with continuous states and actions (CSA-MDP), known only by its simulator.
#pragma once

#include <concepts>
#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/core/box.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"

namespace surefoot {

/// What one transition of a problem gives.
template <class State>
struct Step {
  State next;
  double reward = 0;      // of the transition, in the problem's own unit
  bool terminal = false;  // true: the run ends here and nothing follows
};

/// A problem that offers a second description of its states for regression: angles as points on the circle, a ball in
/// Cartesian coordinates. `static constexpr int feature_dim; Vec<feature_dim> features(const State&) const`.
template <class P>
concept HasFeatures = requires(const P& problem, const typename P::State& state) {
  requires P::feature_dim > 0;
  { problem.features(state) } -> std::same_as<Vec<P::feature_dim>>;
};

/// False for a type whose `feature_dim` and `features` do not fit together, or of which one is missing.
template <class P>
concept FeaturesFit = HasFeatures<P> || !(requires { P::feature_dim; } || requires { &P::features; });

/// A vector of N numbers: Vec<N> itself, or a type of one's own that derives from it to give the numbers names, without
/// data of its own:
///
///   struct Boat : surefoot::Vec<2> {
///     using surefoot::Vec<2>::Vec;  // its constructors
///     double distance() const { return (*this)[0]; }  // [m]
///   };
template <class T, int N>
concept VecLike = std::derived_from<T, Vec<N>> && sizeof(T) == sizeof(Vec<N>) && std::convertible_to<Vec<N>, T>;

/// A CSA-MDP as a black box. The smallest conforming struct:
///
///   struct Integrator {
///     static constexpr int state_dim = 1, action_dim = 1;
///     using State = surefoot::Vec<1>;
///     using Action = surefoot::Vec<1>;
///     surefoot::Box<1> state_box() const { return surefoot::Box<1>::symmetric(State(1)); }
///     surefoot::Box<1> action_box() const { return surefoot::Box<1>::symmetric(Action(0.1)); }
///     State initial_state(surefoot::Rng& rng) const { return state_box().sample(rng); }
///     surefoot::Step<State> step(const State& s, const Action& a, surefoot::Rng&) const {
///       return {state_box().clamp(s + a), -s.squaredNorm(), false};
///     }
///   };
///
/// `step` must be const, draw all its randomness from the Rng it is given, and be safe to call from several threads.
/// `state_box` is where states normally are (it scales exploration, and RFPI learns inside it); a state may leave it.
/// Optional members, used where present: `features(state)` (see HasFeatures), `state_names()`, `action_names()`.
template <class P>
concept Problem =
    requires(const P& problem, const typename P::State& state, const typename P::Action& action, Rng& rng) {
      requires P::state_dim > 0;
      requires P::action_dim > 0;
      requires VecLike<typename P::State, P::state_dim>;
      requires VecLike<typename P::Action, P::action_dim>;
      { problem.state_box() } -> std::same_as<Box<P::state_dim>>;
      { problem.action_box() } -> std::same_as<Box<P::action_dim>>;
      { problem.initial_state(rng) } -> std::same_as<typename P::State>;
      { problem.step(state, action, rng) } -> std::same_as<Step<typename P::State>>;
      requires FeaturesFit<P>;
    };

/// Deliberately empty: naming a member of it is how explain_problem() and explain_policy() speak through the compiler.
template <class T>
struct Incomplete {};

/// A compile error of one sentence about the first member that keeps P from being a Problem; the compiler quotes the
/// line with the declaration wanted. Algorithms that take a problem have an overload for types that are none:
///
///   template <class P>
///     requires(!Problem<P>)
///   auto solve(const P&, const SolveOptions&, auto&&...) { return explain_problem<P>(); }
///
/// Its deduced type stays unknown, so that nothing the caller does with the result is an error of its own.
template <class P>
auto explain_problem() {
  if constexpr (!requires { requires P::state_dim > 0; }) {
    return Incomplete<P>::state_dim;  // static constexpr int state_dim: above 0
  } else if constexpr (!requires { requires P::action_dim > 0; }) {
    return Incomplete<P>::action_dim;  // static constexpr int action_dim: above 0
  } else if constexpr (!requires { requires VecLike<typename P::State, P::state_dim>; }) {
    return Incomplete<P>::State;  // using State = surefoot::Vec<state_dim>, or a type that derives from it
  } else if constexpr (!requires { requires VecLike<typename P::Action, P::action_dim>; }) {
    return Incomplete<P>::Action;  // using Action = surefoot::Vec<action_dim>, or a type that derives from it
  } else if constexpr (!requires(const P& p) {
                         { p.state_box() } -> std::same_as<Box<P::state_dim>>;
                       }) {
    return Incomplete<P>::state_box;  // surefoot::Box<state_dim> state_box() const
  } else if constexpr (!requires(const P& p) {
                         { p.action_box() } -> std::same_as<Box<P::action_dim>>;
                       }) {
    return Incomplete<P>::action_box;  // surefoot::Box<action_dim> action_box() const
  } else if constexpr (!requires(const P& p, Rng& r) {
                         { p.initial_state(r) } -> std::same_as<typename P::State>;
                       }) {
    return Incomplete<P>::initial_state;  // State initial_state(surefoot::Rng&) const
  } else if constexpr (!FeaturesFit<P>) {
    return Incomplete<P>::features;  // feature_dim and Vec<feature_dim> features(const State&) const, or neither
  } else {
    return Incomplete<P>::step;  // surefoot::Step<State> step(const State&, const Action&, surefoot::Rng&) const
  }
}

/// Number of inputs of a regression over this problem's states.
template <class P>
constexpr int feature_dim() {
  if constexpr (HasFeatures<P>) {
    return P::feature_dim;
  } else {
    return P::state_dim;
  }
}

/// The inputs of a regression over this problem's states: its features, or the state itself.
template <Problem P>
Vec<feature_dim<P>()> features(const P& problem, const typename P::State& state) {
  if constexpr (HasFeatures<P>) {
    return problem.features(state);
  } else {
    return state;
  }
}

/// Names of the state's dimensions: the problem's own, or "state 0", "state 1", ...
template <Problem P>
std::vector<std::string> state_names(const P& problem) {
  if constexpr (requires { problem.state_names(); }) {
    return problem.state_names();
  } else {
    std::vector<std::string> names;
    for (int i = 0; i < P::state_dim; ++i) names.push_back("state " + std::to_string(i));
    return names;
  }
}

}  // namespace surefoot
