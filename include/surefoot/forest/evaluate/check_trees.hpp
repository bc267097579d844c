// The check of trees from a file, which are then used without looking: no input leads out of them or round in circles.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

/// What is wrong with a node whose children, if it has any, are good or not.
inline const char* fault(const Node& node, const TreesShape& trees, bool good_children) {
  if (node.is_leaf()) {
    return node.input() != trees.inputs ? "a leaf must name the slot behind the last input"
                                        : "its leaf value is not a finite number or not in the table";
  }
  if (node.input() >= trees.inputs) return "it tests an input that does not exist";
  return good_children ? "its threshold is not finite" : "its children are not where they can be";
}

/// Throws a CoreError unless every descent ends in a leaf with finite numbers and every node belongs to one tree only.
/// One pass whose only branch is never taken for a good forest: leaves and inner nodes come in no order that could be
/// predicted. `Storage`: Trees or TreesView.
template <class Storage>
void check_trees(const Storage& trees, const ByteReader& in) {
  const std::size_t count = trees.nodes.size();
  const std::size_t nowhere = count + count % 2;
  std::vector<std::uint8_t> reached(nowhere + 2, 0);  // has a parent, or is a root
  std::size_t next_root = 0;
  for (const std::uint32_t root : trees.roots) {
    if (root >= count || root % nodes_per_line != 0 || root < next_root) in.fail("has a bad list of roots");
    reached[root] = 1;
    next_root = root + nodes_per_line;
  }
  constexpr std::uint32_t lowest = sort_key(std::numeric_limits<float>::lowest());
  constexpr std::uint32_t highest = sort_key(std::numeric_limits<float>::max());
  constexpr std::uint32_t infinity = 0x7F800000U;
  const std::uint32_t number_mask = trees.inline_leaves() ? 0x7FFFFFFFU : ~0U;  // takes a float's sign off
  const auto number_end =
      trees.inline_leaves() ? infinity : static_cast<std::uint32_t>(std::max<std::size_t>(trees.leaves, 1));
  const auto slot = static_cast<std::uint32_t>(trees.inputs);
  std::size_t leaves = 0;
  for (std::size_t i = 0; i < count; ++i) {  // numbers for truth values: compilers make branches of those
    const Node node = trees.nodes[i];
    const auto input = static_cast<std::uint32_t>(node.input());
    const std::uint32_t inner = node.is_leaf() ? 0 : ~0U;  // a mask
    const std::size_t child = i + node.distance();
    const std::size_t target = std::min(child, nowhere);
    const std::uint32_t bad_children = (child + 1 >= count ? 1U : 0U) | (child & 1U) | reached[target];
    const std::uint32_t bad_inner =
        bad_children | (input >= slot ? 1U : 0U) | (node.key() - lowest > highest - lowest ? 1U : 0U);
    const std::uint32_t bad_leaf = (input ^ slot) | ((node.payload() & number_mask) >= number_end ? 1U : 0U);
    if (((bad_inner & inner) | (bad_leaf & ~inner)) != 0) [[unlikely]] {
      in.fail("has a bad node " + std::to_string(i) + ": " + fault(node, trees, bad_children == 0));
    }
    leaves += reached[i] & ~inner;
    // A leaf "goes on" to itself and must not change what is known of it.
    const std::uint32_t passed_on = reached[i] & inner;
    const std::size_t inner_address = std::size_t{0} - (inner & 1U);
    const std::size_t left = (target & inner_address) | (nowhere & ~inner_address);
    reached[left] = static_cast<std::uint8_t>(passed_on);
    reached[left + 1] = static_cast<std::uint8_t>(passed_on);
  }
  if (leaves != trees.leaves) {
    in.fail("has " + std::to_string(leaves) + " leaves, its header says " + std::to_string(trees.leaves));
  }
  for (std::size_t i = 0; i < trees.parameters.size(); ++i) {
    if (!std::isfinite(trees.parameters[i])) in.fail("has a leaf number that is not finite: " + std::to_string(i));
  }
}

}  // namespace surefoot::detail
