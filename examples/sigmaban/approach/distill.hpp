// A smaller forest that does what a larger one does: one tree with linear leaves, grown where it pays most, learnt from
// the larger policy's actions in the states that its runs visit, and in those that runs of the smaller one visit.
// Hinton, Vinyals, Dean: "Distilling the Knowledge in a Neural Network", 2015, applied to forests; Ross, Gordon,
// Bagnell: "A Reduction of Imitation Learning and Structured Prediction to No-Regret Online Learning" (DAgger), 2011.
// With so many samples one large tree beats many small ones of the same total size.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/visited_states.hpp"

namespace sigmaban {

struct DistillOptions {
  int runs = 40'000;  // from the problem's starts, of each policy
  int horizon = 14;   // [transitions] of each run: later it stands where it may kick, and there is little to learn
  int rounds = 2;     // smaller policies whose runs are shown how to go on
  int min_leaf = 30;  // fewest states in a leaf
  int draws = 8;      // thresholds tried per input: a single tree has no others to average bad splits with
  int split_samples = 1000;  // about so many states of a node score a split
};

template <surefoot::Problem P>
using Demonstrations = surefoot::Dataset<surefoot::feature_dim<P>(), P::action_dim>;

/// What the larger policy does where `walker` goes: features in, actions out.
template <surefoot::Problem P, surefoot::Executor E>
Demonstrations<P> demonstrations(const surefoot::ForestPolicy<P>& policy, const surefoot::ForestPolicy<P>& walker,
                                 const DistillOptions& options, const E& executor, std::uint64_t seed) {
  using State = typename P::State;
  constexpr int inputs = surefoot::feature_dim<P>();
  constexpr double exploration = 0;  // where the smaller policy errs is seen in its runs
  const auto act = [&](std::span<const State> states) { return walker.act(states); };
  const std::vector<State> states =
      surefoot::visited_states(policy.problem(), act, static_cast<std::size_t>(options.runs), options.horizon,
                               exploration, executor, surefoot::Rng(seed));
  const auto count = static_cast<Eigen::Index>(states.size());
  const std::vector<float> rows = surefoot::feature_rows<P>(policy.problem(), states);
  Demonstrations<P> data;
  data.inputs = Eigen::Map<const Eigen::Matrix<float, inputs, Eigen::Dynamic>>(rows.data(), inputs, count);
  data.outputs.resize(P::action_dim, count);
  constexpr std::size_t block = 4096;
  executor.run((states.size() + block - 1) / block,
               [&](std::size_t job) {
                 const std::size_t first = job * block;
                 const auto part = std::span(states).subspan(first, std::min(block, states.size() - first));
                 const auto actions = policy.act(part);
                 for (std::size_t i = 0; i < actions.size(); ++i)
                   data.outputs.col(static_cast<Eigen::Index>(first + i)) = actions[i];
               },
               {});
  return data;
}

/// One tree of at most `leaves` leaves that imitates the demonstrations.
template <surefoot::Problem P, surefoot::Executor E>
surefoot::ForestPolicy<P> imitate(const P& problem, const Demonstrations<P>& demonstrations, int leaves,
                                  const DistillOptions& options, const E& executor, std::uint64_t seed) {
  surefoot::ExtraTreesOptions tree;
  tree.trees = 1;
  tree.max_leaves = leaves;
  tree.min_leaf = options.min_leaf;
  tree.draws = options.draws;
  tree.split_samples = options.split_samples;
  tree.threshold_rule = surefoot::ThresholdRule::balanced;
  return {problem, surefoot::train_extra_trees<surefoot::LinearLeaf>(demonstrations, tree, executor, seed)};
}

/// What the larger policy does along its own runs and, round after round, along those of the imitation of what was
/// shown so far, with so many leaves.
template <surefoot::Problem P, surefoot::Executor E>
Demonstrations<P> demonstrations_to_imitators(const surefoot::ForestPolicy<P>& policy, int leaves,
                                              const DistillOptions& options, const E& executor, std::uint64_t seed) {
  Demonstrations<P> data = demonstrations(policy, policy, options, executor, seed);
  for (int round = 1; round <= options.rounds; ++round) {
    const auto imitator = imitate(policy.problem(), data, leaves, options, executor, seed);
    const auto more = demonstrations(policy, imitator, options, executor, seed + static_cast<std::uint64_t>(round));
    const Eigen::Index before = data.inputs.cols(), added = more.inputs.cols();
    data.inputs.conservativeResize(Eigen::NoChange, before + added);
    data.outputs.conservativeResize(Eigen::NoChange, before + added);
    data.inputs.rightCols(added) = more.inputs;
    data.outputs.rightCols(added) = more.outputs;
  }
  return data;
}

}  // namespace sigmaban
