// Growth of all trees of a forest; see extra_trees.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/options.hpp"
#include "surefoot/forest/train/bootstrap.hpp"
#include "surefoot/forest/train/pool.hpp"
#include "surefoot/forest/train/records.hpp"
#include "surefoot/forest/train/tree_grower.hpp"

namespace surefoot::detail {

/// A data set ready for training: records, and what a unit of squared error of each output counts.
struct TrainingSet {
  RecordShape shape;
  Records records;
  std::vector<double> output_scale;
};

/// The samples must have passed check(). Throws a ForestError if the options are wrong or there is too much of
/// something.
TrainingSet training_set(const DatasetView& samples, const ExtraTreesOptions& options);

/// One forest of all trees, the gains added up.
GrownTrees join(std::vector<GrownTrees> grown);

template <Executor E>
GrownTrees grow_forest(const LeafKind& leaf, const TrainingSet& set, const ExtraTreesOptions& options,
                       const E& executor, std::uint64_t seed, std::stop_token stop) {
  Pool<GrowthBuffers> pool;
  return join(map(
      executor, static_cast<std::size_t>(options.trees),
      [&](std::size_t tree) {
        const auto buffers = pool.borrow();
        return grow_tree(leaf, set.records, set.shape, set.output_scale, options, tree_seed(seed, tree), *buffers);
      },
      std::move(stop)));
}

/// Does the work of train_extra_trees.
template <LeafModel Leaf, int Inputs, int Outputs, Executor E>
GrownTrees grow_forest(const Dataset<Inputs, Outputs>& samples, const ExtraTreesOptions& options, const E& executor,
                       std::uint64_t seed, std::stop_token stop) {
  check(samples);
  return grow_forest(leaf_kind<Leaf>(), training_set(view_of(samples), options), options, executor, seed, stop);
}

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/train/grow_forest.ipp"
#endif
