// Definitions of surefoot/forest/evaluate/blocks.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/evaluate/blocks.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

/// A part of a tree before it has its place.
struct TreePart {
  std::array<std::uint32_t, nodes_per_block> nodes{};  // indices, as those of exits
  std::array<std::uint32_t, exits_per_block> exits{};
  std::array<std::uint8_t, exits_per_block> passed{};  // as in a block with nothing else in it
  std::size_t size = 1;                                // exits; one node fewer
  bool last = false;                                   // all exits are leaves
  std::size_t first_below = 0;                         // if not: index of the part below the first exit; others follow
  PartReference reference = 0;
};

/// The leaves below each node.
inline std::vector<std::uint32_t> count_leaves(const NodeArray& nodes) {
  std::vector<std::uint32_t> leaves(nodes.size(), 1);
  for (std::size_t i = nodes.size(); i-- > 0;) {  // children lie behind their parents
    if (nodes[i].is_leaf()) continue;
    const std::size_t left = i + nodes[i].distance();
    leaves[i] = leaves[left] + leaves[left + 1];
  }
  return leaves;
}

/// An exit becomes a node, and the node's children exits.
inline void split(const NodeArray& nodes, std::size_t exit, TreePart& part) {
  const std::uint32_t node = part.exits[exit];
  for (std::size_t e = part.size; e > exit; --e) {
    part.exits[e] = part.exits[e - 1];
    part.passed[e] = part.passed[e - 1];
  }
  const std::size_t number = part.size++ - 1;
  part.nodes[number] = node;
  part.exits[exit] = node + nodes[node].distance();
  part.exits[exit + 1] = part.exits[exit] + 1;
  part.passed[exit] = static_cast<std::uint8_t>(part.passed[exit] | (1U << number));
}

/// The part below `top`: the whole subtree if it fits. If not, the exits with most leaves below are split, since most
/// paths go there, but none that will fit into a last part.
inline TreePart cut_part(const NodeArray& nodes, const std::vector<std::uint32_t>& leaves, std::uint32_t top) {
  TreePart part;
  part.exits[0] = top;
  part.last = leaves[top] <= exits_per_block;
  if (part.last) {
    for (std::size_t exit = 0; exit < part.size;) {
      if (nodes[part.exits[exit]].is_leaf()) {
        ++exit;
      } else {
        split(nodes, exit, part);
      }
    }
    return part;
  }
  while (part.size < exits_per_block) {
    std::size_t widest = 0;
    for (std::size_t e = 1; e < part.size; ++e) {
      if (leaves[part.exits[e]] > leaves[part.exits[widest]]) widest = e;
    }
    if (leaves[part.exits[widest]] <= exits_per_block) break;
    split(nodes, widest, part);
  }
  return part;
}

/// All parts of a tree: the uppermost first, children behind their parents.
inline std::vector<TreePart> cut_tree(const NodeArray& nodes, const std::vector<std::uint32_t>& leaves,
                                      std::uint32_t root) {
  std::vector<TreePart> parts{cut_part(nodes, leaves, root)};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].last) continue;
    parts[i].first_below = parts.size();
    for (std::size_t exit = 0; exit < parts[i].size; ++exit) {
      parts.push_back(cut_part(nodes, leaves, parts[i].exits[exit]));
    }
  }
  return parts;
}

/// Puts the nodes of a part behind the `used_nodes` of the block, and its exits, still without a value, behind the
/// `used_exits`.
inline void put_nodes(const NodeArray& nodes, const TreePart& part, std::size_t used_nodes, std::size_t used_exits,
                      Block& block) {
  for (std::size_t i = 0; i + 1 < part.size; ++i) {
    const Node node = nodes[part.nodes[i]];
    block.keys[used_nodes + i] = static_cast<std::int32_t>(node.key() ^ 0x80000000U);
    block.inputs |= static_cast<std::uint32_t>(node.input()) << (4 * (used_nodes + i));
  }
  for (std::size_t e = 0; e < part.size; ++e) {
    block.passed[used_exits + e] = static_cast<std::uint8_t>(part.passed[e] << used_nodes);
  }
}

/// Gives each part its place in new blocks: the largest first, and what is left of a block to the largest that fit.
inline void place_parts(const NodeArray& nodes, std::vector<TreePart>& parts, Blocks& out) {
  std::array<std::vector<std::size_t>, exits_per_block + 1> of_size;  // parts without a place, the next one at the end
  for (std::size_t i = parts.size(); i-- > 0;) of_size[parts[i].size].push_back(i);
  for (std::size_t largest = exits_per_block; largest > 0;) {
    if (of_size[largest].empty()) {
      --largest;
      continue;
    }
    const auto offset = static_cast<PartReference>(out.blocks.size() * sizeof(Block));
    Block& block = out.blocks.emplace_back();
    std::size_t used_nodes = 0, used_exits = 0;
    for (std::size_t size = largest; size > 0; size = std::min(size, exits_per_block - used_exits)) {
      if (of_size[size].empty()) {
        --size;
        continue;
      }
      TreePart& part = parts[of_size[size].back()];
      of_size[size].pop_back();
      part.reference = offset + 8 * static_cast<PartReference>(used_exits) + (part.last ? last_part : 0);
      put_nodes(nodes, part, used_nodes, used_exits, block);
      used_nodes += part.size - 1;
      used_exits += part.size;
    }
  }
}

/// The values of the exits, once all parts have a place.
inline void put_exits(const NodeArray& nodes, const std::vector<TreePart>& parts, Blocks& out) {
  for (const TreePart& part : parts) {
    Block& block = out.blocks[(part.reference & block_offset) / sizeof(Block)];
    const std::size_t first = part.reference / 8 % 8;
    for (std::size_t e = 0; e < part.size; ++e) {
      block.exits[first + e] = part.last ? nodes[part.exits[e]].payload() : parts[part.first_below + e].reference;
    }
  }
}

SUREFOOT_INLINE Blocks make_blocks(const Trees& trees) {
  const std::vector<std::uint32_t> leaves = count_leaves(trees.nodes);
  Blocks out;
  for (const std::uint32_t root : trees.roots) {
    std::vector<TreePart> parts = cut_tree(trees.nodes, leaves, root);
    place_parts(trees.nodes, parts, out);
    put_exits(trees.nodes, parts, out);
    out.roots.push_back(parts[0].reference);
  }
  return out;
}

}  // namespace surefoot::detail
