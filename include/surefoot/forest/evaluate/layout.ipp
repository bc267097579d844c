// Definitions of surefoot/forest/evaluate/layout.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/evaluate/layout.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

SUREFOOT_INLINE std::size_t pairs_below(const std::vector<GrownNode>& tree, std::uint32_t node, std::size_t bound) {
  if (bound == 0 || tree[node].is_leaf()) return 0;
  const std::size_t left = pairs_below(tree, tree[node].left, bound - 1);
  return 1 + left + pairs_below(tree, tree[node].left + 1, bound - 1 - left);
}

SUREFOOT_INLINE NodeArray lay_out(const std::vector<GrownNode>& tree, int inputs) {
  const Node unused = Node::leaf(inputs, 0);
  NodeArray nodes;
  nodes.reserve(tree.size() + tree.size() / 8 + nodes_per_line);
  nodes.resize(2, unused);
  std::vector<std::uint32_t> place(tree.size(), 0);
  std::vector<std::uint32_t> frontier;                              // nodes placed, whose children are not
  std::vector<std::uint32_t> lines;                                 // nodes whose children start a line
  std::array<std::vector<std::uint32_t>, pairs_per_line> remnants;  // nodes with so many pairs below: less than a line

  // Places up to `room` pairs from below `top`; what is left over waits in `lines` and `remnants`.
  auto place_pairs = [&](std::uint32_t top, std::size_t room) {
    auto less_visited = [&](std::uint32_t a, std::uint32_t b) {
      return tree[a].count < tree[b].count || (tree[a].count == tree[b].count && a > b);
    };
    frontier.assign(1, top);
    for (; room > 0 && !frontier.empty(); --room) {
      const auto hottest = std::max_element(frontier.begin(), frontier.end(), less_visited);
      const std::uint32_t left = tree[*hottest].left;
      frontier.erase(hottest);
      for (std::uint32_t child = left; child <= left + 1; ++child) {
        place[child] = static_cast<std::uint32_t>(nodes.size());
        nodes.push_back(Node::leaf(inputs, tree[child].payload));
        if (!tree[child].is_leaf()) frontier.push_back(child);
      }
    }
    std::sort(frontier.begin(), frontier.end(), less_visited);
    for (const std::uint32_t node : frontier) {
      const std::size_t pairs = pairs_below(tree, node, pairs_per_line);
      (pairs < pairs_per_line ? remnants[pairs] : lines).push_back(node);
    }
  };

  if (tree[0].is_leaf()) {
    nodes[0] = Node::leaf(inputs, tree[0].payload);
  } else {
    place_pairs(0, pairs_per_line - 1);
  }
  while (!lines.empty()) {  // depth first, the most visited first
    const std::uint32_t top = lines.back();
    lines.pop_back();
    place_pairs(top, pairs_per_line);
  }
  for (std::size_t pairs = pairs_per_line - 1; pairs > 0; --pairs) {
    for (const std::uint32_t top : remnants[pairs]) {
      const std::size_t room = pairs_per_line - nodes.size() / 2 % pairs_per_line;
      if (pairs > room) nodes.resize(nodes.size() + 2 * room, unused);
      place_pairs(top, pairs);
      if (pairs + 1 == pairs_per_line && !remnants[1].empty()) {  // a single pair fills the line up
        const std::uint32_t single = remnants[1].back();
        remnants[1].pop_back();
        place_pairs(single, 1);
      }
    }
  }
  nodes.resize((nodes.size() + nodes_per_line - 1) / nodes_per_line * nodes_per_line, unused);

  for (std::size_t i = 0; i < tree.size(); ++i) {
    if (tree[i].is_leaf()) continue;
    const std::uint32_t distance = place[tree[i].left] - place[i];
    if (distance > Node::max_distance) throw ForestError("a tree can have at most 2^24 nodes; raise min_leaf");
    nodes[place[i]] = Node::inner(tree[i].input, tree[i].threshold, distance);
  }
  return nodes;
}

}  // namespace surefoot::detail
