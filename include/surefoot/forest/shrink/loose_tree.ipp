// Definitions of surefoot/forest/shrink/loose_tree.hpp.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/evaluate/layout.hpp"
#include "surefoot/forest/trees.hpp"
#include "surefoot/forest/shrink/loose_tree.hpp"

namespace surefoot::detail {

SUREFOOT_ONCE LooseTree loosen(const Trees& trees, std::size_t tree) {
  const std::size_t width = trees.leaf_parameters;
  LooseTree loose;
  std::vector<std::size_t> from{trees.roots[tree]};  // of each loose node
  loose.nodes.emplace_back();
  for (std::size_t i = 0; i < loose.nodes.size(); ++i) {
    const Node node = trees.nodes[from[i]];
    loose.numbers.resize((i + 1) * width);
    if (node.is_leaf()) {
      if (trees.inline_leaves()) {
        loose.numbers[i] = std::bit_cast<float>(node.payload());
      } else {
        for (std::size_t k = 0; k < width; ++k) {
          loose.numbers[i * width + k] = trees.parameters[node.payload() * width + k];
        }
      }
      continue;
    }
    loose.nodes[i] = {node.threshold(), node.input(), static_cast<std::uint32_t>(loose.nodes.size()), 0, 0};
    for (std::size_t child = 0; child < 2; ++child) {
      from.push_back(from[i] + node.distance() + child);
      loose.nodes.emplace_back();
    }
  }
  for (std::size_t i = loose.nodes.size(); i-- > 0;) {
    GrownNode& node = loose.nodes[i];
    node.count = node.is_leaf() ? 1 : loose.nodes[node.left].count + loose.nodes[node.left + 1].count;
  }
  return loose;
}

SUREFOOT_ONCE void fasten(const LooseTree& loose, Trees& into) {
  const std::size_t width = into.leaf_parameters;
  Trees one;
  one.inputs = into.inputs;
  one.outputs = into.outputs;
  one.leaf_parameters = width;
  one.roots = {0};
  std::vector<GrownNode> nodes{loose.nodes[0]};
  std::vector<std::size_t> from{0};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].is_leaf()) {
      const std::uint32_t left = nodes[i].left;
      nodes[i].left = static_cast<std::uint32_t>(nodes.size());
      for (std::uint32_t child = left; child <= left + 1; ++child) {
        from.push_back(child);
        nodes.push_back(loose.nodes[child]);
      }
      continue;
    }
    const float* numbers = loose.numbers.data() + from[i] * width;
    if (into.inline_leaves()) {
      nodes[i].payload = std::bit_cast<std::uint32_t>(*numbers);
    } else {
      nodes[i].payload = static_cast<std::uint32_t>(one.leaves);
      one.parameters.insert(one.parameters.end(), numbers, numbers + width);
    }
    ++one.leaves;
  }
  one.nodes = lay_out(nodes, into.inputs);
  into.append(one);
}

SUREFOOT_ONCE Trees without_trees(const Trees& like) {
  Trees trees;
  trees.inputs = like.inputs;
  trees.outputs = like.outputs;
  trees.leaf_parameters = like.leaf_parameters;
  return trees;
}

SUREFOOT_ONCE std::size_t tree_bytes(std::size_t leaves, std::size_t leaf_parameters) {
  const std::size_t lines = (2 * leaves + nodes_per_line - 1) / nodes_per_line;
  const std::size_t numbers = leaf_parameters == 1 ? 0 : leaves * leaf_parameters;
  return lines * nodes_per_line * sizeof(Node) + numbers * sizeof(float) + sizeof(std::uint32_t);
}

}  // namespace surefoot::detail
