// The descent of one input through the blocks of a large forest, with AVX2: all nodes of a block are compared at once,
// and no branch depends on the input but for how many parts a path has. Gives the same leaves as the descent through
// nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/evaluate/blocks.hpp"
#include "surefoot/forest/evaluate/descend.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

constexpr std::size_t nodes_worth_blocks = (std::size_t{256} << 10U) / sizeof(Node);  // fewer are near the core anyway:
                                                                                      // a tenth faster, two copies

#ifdef SUREFOOT_AVX2
static_assert(avx2_slots == block_inputs + 1);

/// The payload of the leaf that one input, given by its wide keys, reaches in each of at most most_in_flight trees.
[[gnu::target("avx2,bmi,bmi2")]] void find_leaves_in_blocks(std::span<const Block> blocks,
                                                            std::span<const PartReference> roots,
                                                            std::span<const std::uint64_t> keys,
                                                            std::uint32_t* payloads);

inline bool can_descend_blocks() {
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("bmi") != 0 &&
         __builtin_cpu_supports("bmi2") != 0;
}
#else
inline void find_leaves_in_blocks(std::span<const Block>, std::span<const PartReference>,
                                  std::span<const std::uint64_t>, std::uint32_t*) {}  // never called
inline bool can_descend_blocks() { return false; }
#endif

/// Whether single predictions are faster through blocks. Eight trees or fewer are not: their nodes stay in registers.
inline bool blocks_pay(const Trees& trees) {
  return trees.nodes.size() >= nodes_worth_blocks && trees.nodes.size() <= most_nodes_in_blocks &&
         trees.roots.size() > lanes && static_cast<std::size_t>(trees.inputs) <= block_inputs && can_descend_blocks();
}

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/evaluate/descend_blocks.ipp"
#endif
