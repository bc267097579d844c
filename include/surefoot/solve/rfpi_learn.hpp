// The forests that an iteration of RFPI learns from its samples: of values, and of actions in the size that does best.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <type_traits>
#include <utility>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/solve/action_leaf.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/rfpi_adapt.hpp"
#include "surefoot/solve/rfpi_options.hpp"
#include "surefoot/solve/rfpi_state.hpp"
#include "surefoot/solve/rfpi_work.hpp"

namespace surefoot::detail {

/// Inputs of a regression over the states of both sets of samples.
template <Problem P>
auto feature_matrix(const P& problem, const StateSamples<P>& a, const StateSamples<P>& b) {
  Eigen::Matrix<float, feature_dim<P>(), Eigen::Dynamic> inputs(feature_dim<P>(), a.size() + b.size());
  Eigen::Index column = 0;
  for (const auto* samples : {&a, &b}) {
    for (const auto& state : samples->states) inputs.col(column++) = features(problem, state).template cast<float>();
  }
  return inputs;
}

/// The forest of actions learnt from two sets of samples.
template <Problem P, Executor E>
auto fit_policy(const P& problem, const StateSamples<P>& a, const StateSamples<P>& b, OpinionsOf opinions,
                const ExtraTreesOptions& options, const E& executor, const Rng& rng, RfpiWork& work,
                std::stop_token stop) {
  Dataset<feature_dim<P>(), P::action_dim> data;
  data.inputs = feature_matrix(problem, a, b);
  data.outputs.resize(P::action_dim, data.inputs.cols());
  const Box<P::action_dim> box = problem.action_box();
  const Vec<P::action_dim> half = 0.5 * box.width();
  Eigen::Index column = 0;
  for (const auto* samples : {&a, &b}) {
    for (const auto& action : samples->actions) {
      auto unit = data.outputs.col(column++);
      for (int i = 0; i < P::action_dim; ++i) unit[i] = half[i] > 0 ? (action[i] - box.center()[i]) / half[i] : 0;
    }
  }
  work.fits += fit_work(a.size() + b.size(), feature_dim<P>(), P::action_dim, options);
  const std::uint64_t seed = Rng(rng).bits();
  Trees trees = opinions == OpinionsOf::actions
                    ? train_extra_trees<LikeActionLeaf>(data, options, executor, seed, std::move(stop)).raw()
                    : train_extra_trees<ActionLeaf>(data, options, executor, seed, std::move(stop)).raw();
  constexpr std::size_t numbers = feature_dim<P>() + 3;  // of a leaf, per dimension of the action
  for (std::size_t i = 0; i < trees.parameters.size(); ++i) {
    const auto dimension = static_cast<Eigen::Index>(i / numbers % P::action_dim);
    const bool slope = i % numbers < feature_dim<P>();
    trees.parameters[i] = static_cast<float>(static_cast<double>(trees.parameters[i]) * half[dimension] +
                                             (slope ? 0.0 : box.center()[dimension]));
  }
  return typename ForestPolicy<P>::ActionForest(std::move(trees));
}

/// The forest of values, likewise.
template <class Leaf, Problem P, Executor E>
auto fit_value(const P& problem, const StateSamples<P>& a, const StateSamples<P>& b, const ExtraTreesOptions& options,
               const E& executor, const Rng& rng, RfpiWork& work, std::stop_token stop) {
  Dataset<feature_dim<P>(), 1> data;
  data.inputs = feature_matrix(problem, a, b);
  data.outputs.resize(1, data.inputs.cols());
  std::copy(a.values.begin(), a.values.end(), data.outputs.data());
  std::copy(b.values.begin(), b.values.end(), data.outputs.data() + a.size());
  work.fits += fit_work(a.size() + b.size(), feature_dim<P>(), 1, options);
  if constexpr (std::is_same_v<Leaf, LinearLeaf>) {
    ExtraTreesOptions compared = options;
    compared.trees = std::min(options.trees, 2 * trend_trees);
    const std::size_t few = std::min(trend_samples, a.size() + b.size());
    work.fits += fit_work(few, feature_dim<P>(), 1, compared);
    return train_value_forest(std::move(data), options, executor, Rng(rng).bits(), std::move(stop));
  } else {
    return train_extra_trees<Leaf>(data, options, executor, Rng(rng).bits(), std::move(stop));
  }
}

/// The cost of a policy over the evaluation runs, as work that counts.
template <Problem P, Executor E>
PolicyCost counted_cost(const P& problem, const typename RfpiState<P>::ActionForest& policy, const RfpiOptions& options,
                        const E& executor, std::uint64_t evaluation_seed, RfpiWork& work) {
  const int runs = evaluation_runs(options);
  const std::uint64_t steps = static_cast<std::uint64_t>(runs) * static_cast<std::uint64_t>(options.horizon);
  work.steps += steps;
  work.lookups += steps * policy.trees();
  return policy_cost(problem, policy, options, runs, executor, evaluation_seed);
}

/// Iterations from one trial of the other kind of opinions to the next, and the one of them that has it.
constexpr int opinions_tried_every = 4, opinions_tried_at = 2;

/// Iterations from one trial of a smaller size to the next where the policy has the largest: each costs a forest.
constexpr int smaller_tried_every = 3;

/// Learns the policy, mostly in another size too, now and then with opinions of the other kind, and keeps the one that
/// does best on the evaluation runs.
template <Problem P, Executor E>
PolicyCost learn_policy(const P& problem, const RfpiOptions& options, const RfpiState<P>& before, RfpiState<P>& after,
                        const E& executor, const Rng& rng, std::uint64_t evaluation_seed, std::stop_token stop) {
  const int most = options.policy_forest.max_leaves;
  const auto learn = [&](int leaves, OpinionsOf opinions) {
    ExtraTreesOptions forest = options.policy_forest;
    forest.max_leaves = leaves;
    return fit_policy(problem, after.samples, after.previous, opinions, forest, executor, rng, after.work, stop);
  };
  const auto cost_of = [&](const typename RfpiState<P>::ActionForest& policy) {
    return counted_cost(problem, policy, options, executor, evaluation_seed, after.work);
  };
  after.leaves = !options.adapt ? most : before.leaves > 0 ? before.leaves : std::max(1, most / 10);
  after.opinions = before.opinions;
  after.policy = learn(after.leaves, after.opinions);
  PolicyCost best = cost_of(after.policy);
  if (most == 0 || !options.adapt) return best;
  const auto try_other = [&](int leaves, OpinionsOf opinions) {
    auto another = learn(leaves, opinions);
    const PolicyCost cost = cost_of(another);
    if (!does_better(cost, best)) return;
    best = cost;
    after.policy = std::move(another);
    after.leaves = leaves;
    after.opinions = opinions;
  };
  if (after.leaves < most || before.iteration % smaller_tried_every == 0) {
    try_other(other_size(after.leaves, most, before.iteration), after.opinions);
  }
  if (before.iteration % opinions_tried_every == opinions_tried_at) {
    try_other(after.leaves, after.opinions == OpinionsOf::actions ? OpinionsOf::distances : OpinionsOf::actions);
  }
  return best;
}

}  // namespace surefoot::detail
