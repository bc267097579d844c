// A forest shrunk to a budget in bytes or time, in whichever way loses least.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/distill.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/fraction_of_variance_unexplained.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/prune.hpp"
#include "surefoot/forest/shrink/loose_tree.hpp"

namespace surefoot {

struct ForestBudget {
  std::size_t bytes = 0;   // most of Forest::bytes(); 0: no limit
  double nanoseconds = 0;  // most per single prediction, measured on this machine; 0: no limit
};

template <int Inputs, int Outputs, LeafModel Leaf>
struct Shrunk {
  Forest<Inputs, Outputs, Leaf> forest;
  std::size_t bytes = 0;
  double nanoseconds = 0;  // per single prediction, measured if the budget limits it, else 0
  double error_before =
      0;  // see fraction_of_variance_unexplained(): share of the variance not explained, on samples set aside
  double error_after = 0;
  std::string how;  // what was done, for a log
};

/// Time of one prediction, one call after the other [ns]: the best of five rounds over up to 1000 of the inputs.
template <int Inputs, int Outputs, LeafModel Leaf>
double nanoseconds_per_prediction(const Forest<Inputs, Outputs, Leaf>& forest,
                                  const Eigen::Matrix<float, Inputs, Eigen::Dynamic>& inputs) {
  std::vector<Vec<Inputs>> points;
  for (Eigen::Index i = 0; i < std::min<Eigen::Index>(1000, inputs.cols()); ++i) {
    points.push_back(inputs.col(i).template cast<double>());
  }
  double best = std::numeric_limits<double>::infinity();
  volatile double sink = 0;  // so that no call is left out
  for (int round = 0; round < 5; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (const Vec<Inputs>& point : points) sink = forest.predict(point)[0];
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count() / static_cast<double>(points.size()));
  }
  static_cast<void>(sink);
  return best;
}

namespace detail {

/// Every fourth sample, or all others.
template <int Inputs, int Outputs>
Dataset<Inputs, Outputs> fourths(const Dataset<Inputs, Outputs>& samples, bool every_fourth) {
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index i = 0; i < samples.inputs.cols(); ++i) {
    if ((i % 4 == 3) == every_fourth) chosen.push_back(i);
  }
  Dataset<Inputs, Outputs> some{samples.inputs(Eigen::all, chosen), samples.outputs(Eigen::all, chosen), {}};
  if (samples.weights.size() != 0) some.weights = samples.weights(chosen);
  return some;
}

}  // namespace detail

/// The best forest within the budget, by its error on a fourth of the samples, of: the best n trees for n = all, half,
/// a fourth, ... 1, pruned; and one tree distilled from all. `Leaf` is the kind of leaves wanted, by default the
/// forest's; of another kind it can only be distilled. `distillation` tells how, its max_leaves as an upper
/// limit. The errors are honest if the forest has not learned from the samples.
/// The same samples and seed give the same forest, except that a limit in time depends on the machine. Throws
/// ForestError if nothing fits.
template <class Leaf = void, int Inputs, int Outputs, LeafModel From, Executor E = Serial>
auto shrink_to(const Forest<Inputs, Outputs, From>& forest, const Dataset<Inputs, Outputs>& samples,
               const ForestBudget& budget, std::uint64_t seed = 1, const E& executor = {},
               const DistillOptions& distillation = {.max_leaves = 1000}) {
  using To = std::conditional_t<std::is_void_v<Leaf>, From, Leaf>;
  using Result = Shrunk<Inputs, Outputs, To>;
  detail::check_fit(forest, samples, "shrink_to");
  check(distillation);
  if (samples.inputs.cols() < 8) throw ForestError("shrink_to: needs at least 8 samples");
  const auto ours = detail::fourths(samples, false);
  const auto aside = detail::fourths(samples, true);
  const std::size_t bytes = budget.bytes != 0 ? budget.bytes : std::numeric_limits<std::size_t>::max();
  Result best;
  best.error_before = fraction_of_variance_unexplained(forest, aside);
  best.error_after = std::numeric_limits<double>::infinity();
  const auto consider = [&](Forest<Inputs, Outputs, To> smaller, const std::string& how) {
    if (smaller.bytes() > bytes) return;
    const double error = fraction_of_variance_unexplained(smaller, aside);
    if (!(error < best.error_after)) return;
    const double time = budget.nanoseconds > 0 ? nanoseconds_per_prediction(smaller, aside.inputs) : 0;
    if (time > budget.nanoseconds) return;
    best.bytes = smaller.bytes();
    best.forest = std::move(smaller);
    best.nanoseconds = time;
    best.error_after = error;
    best.how = how;
  };

  if constexpr (std::same_as<From, To>) {
    const std::size_t smallest = detail::tree_bytes(1, forest.raw().leaf_parameters);
    const std::vector<std::size_t> ranked = best_trees(forest, ours, forest.trees());
    for (std::size_t count = forest.trees(); count > 0; count /= 2) {
      if (count * smallest > bytes) continue;
      const auto kept =
          count == forest.trees() ? forest : keep_trees(forest, std::span<const std::size_t>(ranked).first(count));
      consider(prune(kept, ours, bytes, distillation.leaf, executor),
               std::to_string(count) + " of " + std::to_string(forest.trees()) + " trees, pruned");
    }
  }
  const std::size_t width = To::parameters(forest.inputs(), forest.outputs());
  const auto most = static_cast<std::size_t>(distillation.points / distillation.min_leaf + 1);
  DistillOptions options = distillation;
  const std::size_t room = bytes / static_cast<std::size_t>(options.trees);
  if (room >= detail::tree_bytes(1, width)) {
    std::size_t leaves = std::min({most, static_cast<std::size_t>(options.max_leaves), room / (2 * sizeof(Node))});
    while (detail::tree_bytes(leaves, width) > room) --leaves;
    options.max_leaves = static_cast<int>(leaves);
    const auto distilled = distill<To>(forest, samples.inputs, options, executor, seed).forest;
    const auto points = ask(forest, samples.inputs, options.points, options.mixing, Rng(seed, 0, 0));
    consider(prune(distilled, points, bytes, options.leaf, executor),
             "distilled to " + std::to_string(options.trees) + (options.trees == 1 ? " tree" : " trees"));
  }
  if (best.forest.empty()) {
    throw ForestError("shrink_to: nothing fits into " +
                      (budget.bytes != 0 ? std::to_string(budget.bytes) + " bytes" : std::string("any size")) +
                      (budget.nanoseconds > 0 ? " and " + std::to_string(budget.nanoseconds) + " ns" : std::string()));
  }
  return best;
}

}  // namespace surefoot
