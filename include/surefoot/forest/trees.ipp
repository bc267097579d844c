// Definitions of surefoot/forest/trees.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot {

SUREFOOT_INLINE std::string TreesShape::shape() const {
  return std::to_string(inputs) + " inputs, " + std::to_string(outputs) + " outputs, " +
         std::to_string(leaf_parameters) + " numbers per leaf";
}

SUREFOOT_INLINE void Trees::append(const Trees& other) {
  if (other.inputs != inputs || other.outputs != outputs || other.leaf_parameters != leaf_parameters) {
    throw ForestError("forests to join must have the same inputs, outputs and leaves, got " + shape() + " and " +
                      other.shape());
  }
  const std::size_t start = nodes.size();
  if (start + other.nodes.size() > 0x7FFFFFFFU) throw ForestError("a forest can have at most 2^31 nodes");
  nodes.insert(nodes.end(), other.nodes.begin(), other.nodes.end());
  if (!inline_leaves()) {
    for (std::size_t i = start; i < nodes.size(); ++i) {
      if (nodes[i].is_leaf()) nodes[i] = Node::leaf(inputs, nodes[i].payload() + static_cast<std::uint32_t>(leaves));
    }
  }
  for (const std::uint32_t root : other.roots) roots.push_back(root + static_cast<std::uint32_t>(start));
  parameters.insert(parameters.end(), other.parameters.begin(), other.parameters.end());
  leaves += other.leaves;
}

}  // namespace surefoot
