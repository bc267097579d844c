// Weakest-link pruning of single trees, and the choice among all their steps; see prune.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/trees.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/shrink/loose_tree.hpp"

namespace surefoot::detail {

/// A step of weakest-link pruning: an inner node becomes a leaf.
struct Collapse {
  double cost = 0;  // added squared error per leaf saved; never less than that of the step before
  std::uint32_t node = 0;
  std::size_t leaves = 0;  // saved
  static constexpr auto fields = std::tuple(&Collapse::cost, &Collapse::node, &Collapse::leaves);
};

/// A tree with numbers at all inner nodes, and all steps down to the root alone.
using PrunedTree = std::pair<LooseTree, std::vector<Collapse>>;

/// Works out in what order the inner nodes of one tree become leaves, and with which numbers.
PrunedTree weakest_links(const LeafKind& leaf, LooseTree tree, const DatasetView& samples,
                         std::span<const double> output_scale, const LeafOptions& options);

/// The trees after the cheapest steps until they take at most so many bytes; `like`: trees of the same shape.
Trees collapse_to(std::vector<PrunedTree> pruned, const Trees& like, std::size_t bytes);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/shrink/tree_pruner.ipp"
#endif
