// Pruning, to make a forest smaller: fewer trees, or fewer leaves in each by cost-complexity pruning (Breiman,
// Friedman, Olshen & Stone, "Classification and Regression Trees", 1984, ch. 3).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/fraction_of_variance_unexplained.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/shrink/loose_tree.hpp"
#include "surefoot/forest/shrink/tree_pruner.hpp"

namespace surefoot {

/// A forest of some of the trees of another, in the order given; a tree may come more than once.
template <int Inputs, int Outputs, LeafModel Leaf>
Forest<Inputs, Outputs, Leaf> keep_trees(const Forest<Inputs, Outputs, Leaf>& forest,
                                         std::span<const std::size_t> trees) {
  if (trees.empty()) throw ForestError("keep_trees: needs at least one tree");
  Trees kept = detail::without_trees(forest.raw());
  for (const std::size_t tree : trees) {
    if (tree >= forest.trees()) {
      throw ForestError("keep_trees: there is no tree " + std::to_string(tree) + ", the forest has " +
                        std::to_string(forest.trees()));
    }
    detail::fasten(detail::loosen(forest.raw(), tree), kept);
  }
  return Forest<Inputs, Outputs, Leaf>(std::move(kept));
}

/// The trees whose mean fits the samples best, chosen one after the other, so the first n of them are also the choice
/// for n (forward selection; Caruana et al. 2004). `count` of them, 1 to all. Time: O(trees * count * samples); memory:
/// the predictions of every tree. Use samples that the forest has not learned from.
template <int Inputs, int Outputs, LeafModel Leaf>
std::vector<std::size_t> best_trees(const Forest<Inputs, Outputs, Leaf>& forest,
                                    const Dataset<Inputs, Outputs>& samples, std::size_t count) {
  detail::check_fit(forest, samples, "best_trees");
  if (count < 1 || count > forest.trees()) {
    throw ForestError("best_trees: count must be 1 to " + std::to_string(forest.trees()) + ", got " +
                      std::to_string(count));
  }
  const std::vector<double> scale = detail::inverse_variances(detail::view_of(samples));
  Eigen::ArrayXXd weights(samples.outputs.rows(), samples.outputs.cols());  // of each squared error
  for (Eigen::Index o = 0; o < weights.rows(); ++o) weights.row(o).setConstant(scale[static_cast<std::size_t>(o)]);
  if (samples.weights.size() != 0) weights.rowwise() *= samples.weights.transpose().array();
  std::vector<typename Forest<Inputs, Outputs, Leaf>::BatchOutput> predicted(forest.trees());
  for (std::size_t tree = 0; tree < forest.trees(); ++tree) {
    keep_trees(forest, std::span<const std::size_t>(&tree, 1)).predict(samples.inputs, predicted[tree]);
  }
  std::vector<std::size_t> chosen;
  Eigen::ArrayXXd sum = Eigen::ArrayXXd::Zero(weights.rows(), weights.cols());
  while (chosen.size() < count) {
    const double share = 1 / static_cast<double>(chosen.size() + 1);
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t tree = 0; tree < forest.trees(); ++tree) {
      if (std::find(chosen.begin(), chosen.end(), tree) != chosen.end()) continue;
      const double error =
          (weights * ((sum + predicted[tree].array()) * share - samples.outputs.array()).square()).sum();
      if (error < least) {
        least = error;
        best = tree;
      }
    }
    chosen.push_back(best);
    sum += predicted[best].array();
  }
  return chosen;
}

/// Prunes all trees by one measure until Forest::bytes() is at most `bytes`: again and again the inner node becomes a
/// leaf that adds the least squared error on the samples per leaf saved; its leaf is fitted to the samples there. Other
/// leaves stay as they are. Give at least as many samples as the forest was trained on, the same ones or others.
/// `options`: how leaves are fitted. Throws ForestError if even single leaves take more. Time: a leaf fit to the
/// samples per level of each tree.
template <int Inputs, int Outputs, LeafModel Leaf, Executor E = Serial>
Forest<Inputs, Outputs, Leaf> prune(const Forest<Inputs, Outputs, Leaf>& forest,
                                    const Dataset<Inputs, Outputs>& samples, std::size_t bytes,
                                    const LeafOptions& options = {}, const E& executor = {}) {
  detail::check_fit(forest, samples, "prune");
  const std::size_t width = forest.raw().leaf_parameters;
  const std::size_t least = forest.trees() * detail::tree_bytes(1, width);
  if (least > bytes) {
    throw ForestError("prune: " + std::to_string(forest.trees()) + " trees take at least " + std::to_string(least) +
                      " bytes, asked for " + std::to_string(bytes) + "; keep fewer trees");
  }
  if (forest.bytes() <= bytes) return forest;
  const std::vector<double> scale = detail::inverse_variances(detail::view_of(samples));
  auto pruned = map(executor, forest.trees(), [&](std::size_t tree) {
    return detail::weakest_links(detail::leaf_kind<Leaf>(), detail::loosen(forest.raw(), tree),
                                 detail::view_of(samples), scale, options);
  });
  return Forest<Inputs, Outputs, Leaf>(detail::collapse_to(std::move(pruned), forest.raw(), bytes));
}

}  // namespace surefoot
