// Distillation: one tree, or a few, that do what a whole forest does, learned from the forest's answers at as many
// points as wanted. After Breiman & Shang, "Born again trees", 1996.
//
// The tree is an extra-tree grown best first from many thresholds per input: a lone tree cannot average bad splits
// away, so it is worth looking for good ones.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/trees.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/fraction_of_variance_unexplained.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/options.hpp"

namespace surefoot {

struct DistillOptions {
  int trees = 1;
  int max_leaves = 64;    // per tree
  int min_leaf = 8;       // fewest points in a leaf
  int draws = 64;         // thresholds tried for each input at each split
  int points = 40'000;    // that the forest is asked at, per tree
  double mixing = 0.5;    // chance of each input of a point to come from another sample, 0..1
  LeafOptions leaf = {};  // how leaves are fitted
};

/// Throws a ForestError that names the field and its range.
void check(const DistillOptions& options);

template <int Inputs, int Outputs, LeafModel Leaf>
struct Distilled {
  Forest<Inputs, Outputs, Leaf> forest;
  double loss = 0;  // fraction of the variance of the larger forest's answers at fresh points that is lost; 0: none
};

/// Points where the data is, and the forest's answers there: each is a sample's input, but every component comes from
/// another random sample with probability `mixing`. 0: the samples themselves; 1: any combination of their values, for
/// evenly spread samples the whole box.
template <int Inputs, int Outputs, LeafModel Teacher>
Dataset<Inputs, Outputs> ask(const Forest<Inputs, Outputs, Teacher>& forest,
                             const Eigen::Matrix<float, Inputs, Eigen::Dynamic>& inputs, Eigen::Index points,
                             double mixing, Rng rng) {
  if (inputs.cols() == 0 || inputs.rows() != forest.inputs()) {
    throw ForestError("ask: needs at least one sample with the forest's " + std::to_string(forest.inputs()) +
                      " inputs");
  }
  const auto any = [&] {
    const auto count = static_cast<double>(inputs.cols());
    return std::min(static_cast<Eigen::Index>(rng.uniform() * count), inputs.cols() - 1);
  };
  Dataset<Inputs, Outputs> asked;
  asked.inputs.resize(inputs.rows(), points);
  for (Eigen::Index i = 0; i < points; ++i) {
    const Eigen::Index from = any();
    for (Eigen::Index k = 0; k < inputs.rows(); ++k) {
      asked.inputs(k, i) = inputs(k, rng.uniform() < mixing ? any() : from);
    }
  }
  forest.predict(asked.inputs, asked.outputs);
  return asked;
}

/// Learns a smaller forest, with `Leaf` leaves, from the forest's answers around `inputs` (one sample per column: where
/// it will be used). The result is the same for any executor. Throws ForestError if the forest is empty or an option is
/// out of range. Time: about that of training trees * draws trees on `points`
/// samples; the trees are grown in parallel.
template <LeafModel Leaf = LinearLeaf, int Inputs, int Outputs, LeafModel Teacher, Executor E>
Distilled<Inputs, Outputs, Leaf> distill(const Forest<Inputs, Outputs, Teacher>& forest,
                                         const Eigen::Matrix<float, Inputs, Eigen::Dynamic>& inputs,
                                         const DistillOptions& options, const E& executor, std::uint64_t seed) {
  check(options);
  if (forest.empty()) throw ForestError("distill: the forest is empty, train or load it first");
  const ExtraTreesOptions growth{.trees = 1,
                                 .draws = options.draws,
                                 .min_leaf = options.min_leaf,
                                 .max_leaves = options.max_leaves,
                                 .ridge = options.leaf.ridge,
                                 .clamp = options.leaf.clamp};
  const auto grown = map(executor, static_cast<std::size_t>(options.trees), [&](std::size_t tree) {
    const auto points = ask(forest, inputs, options.points, options.mixing, Rng(seed, tree, 0));
    return detail::grow_forest<Leaf>(points, growth, Serial{}, Rng(seed, tree, 1).bits(), {}).trees;
  });
  Trees trees = grown.front();
  for (std::size_t tree = 1; tree < grown.size(); ++tree) trees.append(grown[tree]);
  Distilled<Inputs, Outputs, Leaf> result{Forest<Inputs, Outputs, Leaf>(std::move(trees)), 0};
  const auto fresh = ask(forest, inputs, std::max(1000, options.points / 4), options.mixing, Rng(seed, 0, 2));
  result.loss = fraction_of_variance_unexplained(result.forest, fresh);
  return result;
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/distill.ipp"
#endif
