// Trees taken out of a forest, to be changed, and put back: what pruning and distillation work on.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "surefoot/forest/evaluate/layout.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

/// One tree. Children lie behind their parents; entry 0 is the root.
struct LooseTree {
  std::vector<GrownNode> nodes;  // payloads do not count here
  std::vector<float> numbers;    // leaf_parameters per node, of inner nodes too
  static constexpr auto fields = std::tuple(&LooseTree::nodes, &LooseTree::numbers);
};

/// Tree number `tree` of a forest; inner nodes get zeros as their numbers, and as their count the leaves below them.
LooseTree loosen(const Trees& trees, std::size_t tree);

/// Puts one tree behind the others in `into`. Nodes that no longer hang on the root are left out.
void fasten(const LooseTree& loose, Trees& into);

/// A forest without trees, of the shape of another.
Trees without_trees(const Trees& like);

/// The fewest bytes, by Forest::bytes, of a tree with so many leaves. lay_out may add a cache line.
std::size_t tree_bytes(std::size_t leaves, std::size_t leaf_parameters);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/shrink/loose_tree.ipp"
#endif
