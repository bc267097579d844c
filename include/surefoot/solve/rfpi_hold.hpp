// The number of transitions that a lookahead holds an action: until what the action changes outweighs the errors of the
// values.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/rfpi_options.hpp"
#include "surefoot/solve/rfpi_state.hpp"

namespace surefoot::detail {

constexpr int compared_actions = 8;  // random ones, per state

/// Of the first iterations [transitions]. Their values, from V = 0 on, come from lookaheads alone: held for two, values
/// reach twice as far after as many iterations. More makes them those of clumsy policies, and standing still looks
/// best.
constexpr int initial_hold = 2;

/// How well two halves of the value forest agree about which actions are better than others, if each is held for `hold`
/// transitions: the correlation of their Q over random actions of a state, mean over states. What they disagree about
/// is error of the values; where that outweighs what an action changes, the best action is a matter of chance.
template <Problem P, class Value>
double agreement_of_halves(const P& problem, const Value& value, std::span<const typename P::State> states,
                           double discount, int hold, const Rng& rng) {
  const Box<P::action_dim> box = problem.action_box();
  const std::size_t trees = value.trees();
  std::vector<double> by_tree(trees);
  double sum = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    Rng choice = rng.stream(i, 0);
    std::array<Eigen::Array<double, compared_actions, 1>, 2> q;
    for (Eigen::Index a = 0; a < Eigen::Index{compared_actions}; ++a) {
      const typename P::Action action = box.sample(choice);
      Rng noise = rng.stream(i, 1);
      Step<typename P::State> step{states[i], 0, false};
      double reward = 0, weight = 1;
      for (int t = 0; t < hold && !step.terminal; ++t, weight *= discount) {
        step = problem.step(typename P::State(step.next), action, noise);
        reward += weight * step.reward;
      }
      q[0][a] = q[1][a] = reward;
      if (step.terminal) continue;
      const Eigen::Matrix<float, feature_dim<P>(), 1> row = features(problem, step.next).template cast<float>();
      value.predict_trees(row.data(), by_tree.data());
      for (std::size_t half = 0; half < 2; ++half) {
        double mean = 0, count = 0;
        for (std::size_t t = half; t < trees; t += 2, count += 1) mean += by_tree[t];
        q[half][a] += weight * mean / count;
      }
    }
    for (auto& one : q) one -= one.mean();
    const double scale = std::sqrt((q[0] * q[0]).sum() * (q[1] * q[1]).sum());
    sum += scale > 0 ? (q[0] * q[1]).sum() / scale : 1.0;
  }
  return sum / static_cast<double>(states.size());
}

/// As short as halves of the value forest agree.
template <Problem P, class Value>
int chosen_hold(const P& problem, const Value& value, std::span<const typename P::State> states,
                const RfpiOptions& options, const Rng& rng, RfpiWork& work) {
  constexpr std::size_t looked_at = 128;              // states
  constexpr std::array<int, 5> holds{1, 2, 3, 4, 6};  // [transitions]
  constexpr double enough = 0.5;                      // correlation: half of what tells actions apart is no error
  if (value.empty() || value.trees() < 2 || states.empty()) return options.lookahead.hold;
  const auto some = states.first(std::min(looked_at, states.size()));
  for (const int hold : holds) {
    if (hold < options.lookahead.hold) continue;
    work.steps += some.size() * compared_actions * static_cast<std::size_t>(hold);
    work.lookups += some.size() * compared_actions * value.trees();
    if (agreement_of_halves(problem, value, some, options.discount, hold, rng) >= enough) return hold;
  }
  return std::max(holds.back(), options.lookahead.hold);
}

}  // namespace surefoot::detail
