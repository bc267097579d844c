// The layout of a grown tree, so that a descent touches few cache lines: each line of 8 nodes takes a sibling pair and
// then, one after the other, the pairs below it that most training samples reach. O(nodes) time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

/// A tree as it grows: entry 0 is the root, siblings are neighbours.
struct GrownNode {
  float threshold = 0;
  int input = 0;
  std::uint32_t left = 0;     // index of the left child, the right one follows it; 0: this is a leaf
  std::uint32_t count = 0;    // training samples that came here
  std::uint32_t payload = 0;  // of a leaf
  static constexpr auto fields =
      std::tuple(&GrownNode::threshold, &GrownNode::input, &GrownNode::left, &GrownNode::count, &GrownNode::payload);

  bool is_leaf() const { return left == 0; }
};

constexpr std::size_t pairs_per_line = nodes_per_line / 2;

/// Sibling pairs in the tree below a node, counted up to `bound`.
std::size_t pairs_below(const std::vector<GrownNode>& tree, std::uint32_t node, std::size_t bound);

/// The nodes of the tree in their final order: whole cache lines, children behind their parents.
NodeArray lay_out(const std::vector<GrownNode>& tree, int inputs);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/evaluate/layout.ipp"
#endif
