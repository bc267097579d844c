// A second layout of large forests, for single predictions: parts of trees in blocks of one cache line each, so that a
// descent waits for few lines and the forest takes few bytes of the caches.
//
// A part has up to six inner nodes and the exits below them, from left to right: leaves, or the tops of other parts.
// All its nodes are compared at once. An input that goes right at a node has passed all exits below the node's left
// child; the first exit that it has not passed is where it leaves the part (Lucchese et al. 2015, "QuickScorer", who do
// so with whole trees). Nodes with their full thresholds and exits with the full payloads fill the line, so predictions
// are the same bits, and no bytes go to links within a part. Small parts share a block.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

constexpr std::size_t exits_per_block = 7;
constexpr std::size_t nodes_per_block = exits_per_block - 1;
constexpr std::size_t block_inputs = 15;  // most inputs of a forest in blocks: four bits name one

struct alignas(cache_line) Block {
  static constexpr std::int32_t never = std::numeric_limits<std::int32_t>::max();  // no input's key is greater

  // Thresholds of the nodes: sort keys with the top bit flipped, which sort as signed.
  std::array<std::int32_t, nodes_per_block> keys{never, never, never, never, never, never};
  std::array<std::uint32_t, exits_per_block> exits{};  // payloads of leaves, or references of parts
  std::uint32_t inputs = 0;                            // of node i in bits 4 i to 4 i + 3
  std::array<std::uint8_t, 8> passed{};                // of exit e bit i: it lies below the left child of node i

  bool operator==(const Block&) const = default;
};
static_assert(sizeof(Block) == cache_line);

/// Where a part is: the offset of its block in bytes, plus eight times its first exit in there, plus `last_part` if its
/// exits are leaves.
using PartReference = std::uint32_t;
constexpr PartReference last_part = PartReference{1} << 31;
constexpr PartReference block_offset = last_part - cache_line;      // a mask
constexpr std::size_t most_nodes_in_blocks = std::size_t{1} << 26;  // whose blocks all have an offset of 31 bits

/// The trees of a forest in blocks.
struct Blocks {
  std::vector<Block, CacheLineAllocator<Block>> blocks;
  std::vector<PartReference> roots;  // the uppermost part of each tree; none: there are no blocks

  bool operator==(const Blocks&) const = default;
};

/// Trees of at most block_inputs inputs and most_nodes_in_blocks nodes, laid out in blocks. O(nodes) time.
Blocks make_blocks(const Trees& trees);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/evaluate/blocks.ipp"
#endif
