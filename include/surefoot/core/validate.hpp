// A check of a user's problem by running it, with complaints in plain English, before hours of training.
// Cost: about 8 * runs * horizon steps of the problem, one thread besides the caller's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "surefoot/core/box.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"

namespace surefoot {

struct ValidateOptions {
  int runs = 100;    // with random actions, from the problem's initial states
  int horizon = 30;  // [transitions]
};

/// Throws a CoreError that names the field and its range.
void check(const ValidateOptions& options);

namespace detail {

/// A problem with sizes that are known at run time, so that what examines it is compiled once for all problems.
struct ErasedProblem {
  Box<Eigen::Dynamic> states, actions;
  std::vector<std::string> state_names;
  std::optional<std::size_t> action_names;  // how many, where the problem has any
  std::function<Eigen::VectorXd(Rng&)> initial_state;
  std::function<Step<Eigen::VectorXd>(const Eigen::VectorXd& state, const Eigen::VectorXd& action, Rng noise)> step;
  std::function<Eigen::VectorXd(const Eigen::VectorXd& state)> features;  // empty if there are none
  bool features_ignored;                                                  // something is named so, but of another shape
};

template <Problem P>
ErasedProblem erase(const P& problem) {
  using State = typename P::State;
  using Action = typename P::Action;
  const auto box = [](const auto& sized) { return Box<Eigen::Dynamic>(sized.low(), sized.high()); };
  ErasedProblem erased{
      box(problem.state_box()), box(problem.action_box()), state_names(problem), {}, {}, {}, {}, false};
  if constexpr (requires { problem.action_names(); }) erased.action_names = problem.action_names().size();
  erased.initial_state = [&problem](Rng& rng) { return Eigen::VectorXd(problem.initial_state(rng)); };
  erased.step = [&problem](const Eigen::VectorXd& state, const Eigen::VectorXd& action, Rng noise) {
    const auto [next, reward, terminal] =
        problem.step(State(Vec<P::state_dim>(state)), Action(Vec<P::action_dim>(action)), noise);
    return Step<Eigen::VectorXd>{next, reward, terminal};
  };
  if constexpr (HasFeatures<P>) {
    erased.features = [&problem](const Eigen::VectorXd& state) {
      return Eigen::VectorXd(problem.features(State(Vec<P::state_dim>(state))));
    };
  } else {
    erased.features_ignored = requires(const State& s) { problem.features(s); }
    || requires { P::feature_dim; };
  }
  return erased;
}

std::vector<std::string> complaints_about(const ErasedProblem& problem, const ValidateOptions& options,
                                          std::uint64_t seed);

}  // namespace detail

/// Complaints about a problem, each one sentence that names the member and the cure; empty if there are none. What may
/// well be meant starts with "remark: ". Checks: finite numbers, equal results for equal random numbers (again, and on
/// another thread; differences of rounding alone, as fused multiplications and additions make, are told apart), states
/// inside their box, boxes with width, actions that have an effect and may leave their box, rewards that differ, states
/// that change, runs that last, features, names, exceptions.
template <Problem P>
std::vector<std::string> validate(const P& problem, const ValidateOptions& options = {}, std::uint64_t seed = 0) {
  return detail::complaints_about(detail::erase(problem), options, seed);
}

/// What a type that is no Problem gets.
template <class P>
requires(!Problem<P>) auto validate(const P&, const ValidateOptions& = {}, std::uint64_t = 0) {
  return explain_problem<P>();
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/core/validate.ipp"
#endif
