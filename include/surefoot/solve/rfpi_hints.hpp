// Hints in plain words where discount, horizon or exploration cannot fit a problem.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/solve/rfpi_options.hpp"
#include "surefoot/solve/visited_states.hpp"

namespace surefoot {

/// What runs show about the fit of options and problem.
struct LearningSigns {
  double random_cost = 0;   // mean cost of random actions
  double learnt_cost = 0;   // of the learnt policy
  double least_reward = 0;  // of a transition, over the runs of both
  double greatest_reward = 0;
  double ended_share = 0;  // of the learnt policy's runs that a terminal step ended
  double mean_length = 0;  // of the learnt policy's runs [transitions]
  double outside_share = 0;  // of the states they lead to that are outside the state box and further than the start
};

struct HintCriteria {
  double short_sight = 0.5;  // [runs]: a discount that looks less far ahead than this share of a run hides what follows
  double outside = 0.1;  // of the states: so many outside the box that states are learnt in show that it is too small
  double no_gain = 0.02;     // of the random policy's cost: less is no learning
};

/// One sentence for each thing to change; empty if nothing speaks against the options.
std::vector<std::string> hints(const LearningSigns& signs, const RfpiOptions& options, const HintCriteria& = {});

namespace detail {

/// Adds what runs of a policy show; returns their mean cost.
template <Problem P, Policy<P> F>
double add_runs(const P& problem, const F& policy, int horizon, std::uint64_t seed, LearningSigns& signs) {
  constexpr std::size_t runs = 100;
  double cost = 0, length = 0, ended = 0, outside = 0;
  const Box<P::state_dim> box = problem.state_box();
  for (std::size_t i = 0; i < runs; ++i) {
    const Rng rng(seed, i);
    Rng drawn = rng.stream(0);
    const typename P::State start = problem.initial_state(drawn);
    const double reach = half_widths_out<P::state_dim>(box, start);
    run(problem, policy, start, horizon, rng.stream(1), [&](const auto&, const auto&, const auto& step) {
      cost -= step.reward;
      length += 1;
      ended += step.terminal ? 1 : 0;
      outside += half_widths_out<P::state_dim>(box, step.next) > reach ? 1 : 0;
      signs.least_reward = std::min(signs.least_reward, step.reward);
      signs.greatest_reward = std::max(signs.greatest_reward, step.reward);
    });
  }
  signs.ended_share = ended / runs;
  signs.mean_length = length / runs;
  signs.outside_share = outside / length;
  return cost / runs;
}

/// RandomPolicy with the problem's own type of action.
template <Problem P>
struct RandomActions {
  Box<P::action_dim> box;
  Rng rng = Rng(0);
  void reset(const Rng& from) { rng = from; }
  typename P::Action operator()(const typename P::State&) { return box.sample(rng); }
};

template <Problem P, Policy<P> F>
LearningSigns learning_signs(const P& problem, const F& policy, int horizon, std::uint64_t seed) {
  LearningSigns signs;
  signs.least_reward = std::numeric_limits<double>::infinity();
  signs.greatest_reward = -signs.least_reward;
  signs.random_cost = add_runs(problem, RandomActions<P>{problem.action_box()}, horizon, seed, signs);
  signs.learnt_cost = add_runs(problem, policy, horizon, seed, signs);
  return signs;
}

}  // namespace detail
}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/solve/rfpi_hints.ipp"
#endif
