// Definitions of surefoot/forest/trees.hpp.
#pragma once

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <cstddef>
#include <cstdint>
#include <new>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot {

namespace detail {

inline bool takes_large_pages(std::size_t bytes) { return bytes >= 2 * large_page; }

SUREFOOT_INLINE void* allocate_lines(std::size_t bytes) {
  if (!takes_large_pages(bytes)) return ::operator new (bytes, std::align_val_t{cache_line});
  const std::size_t whole = (bytes + large_page - 1) / large_page * large_page;
  void* memory = ::operator new (whole, std::align_val_t{large_page});
#ifdef MADV_HUGEPAGE
  madvise(memory, whole, MADV_HUGEPAGE);  // a wish: without it the memory is as good, only slower
#endif
  return memory;
}

SUREFOOT_INLINE void release_lines(void* memory, std::size_t bytes) {
  ::operator delete (memory, std::align_val_t{takes_large_pages(bytes) ? large_page : cache_line});
}

}  // namespace detail

SUREFOOT_ONCE std::string TreesShape::shape() const {
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
