// The descent of one input through many trees with AVX2: 8 trees per vector, 32 in flight, a node per gathered word,
// and the input's keys in two registers. Gives the same leaves as the portable loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/evaluate/avx2.hpp"
#include "surefoot/forest/trees.hpp"

#ifdef SUREFOOT_AVX2

namespace surefoot::detail {

constexpr std::size_t avx2_trees = 32;  // in flight together

/// The payload of the leaf that one input, given by at most 16 wide keys, reaches in each tree.
[[gnu::target("avx2")]] void find_leaves_avx2(const Node* nodes, std::span<const std::uint32_t> roots,
                                              std::span<const std::uint64_t> keys, std::uint32_t* payloads);

/// The indices of the nodes that it reaches in so many steps from each root. `reached` has room for a whole multiple of
/// avx2_trees: whole vectors are stored, since what a masked store wrote is slow to read back.
[[gnu::target("avx2")]] void take_steps_avx2(const Node* nodes, std::span<const std::uint32_t> roots,
                                             std::span<const std::uint64_t> keys, std::size_t steps,
                                             std::uint32_t* reached);

}  // namespace surefoot::detail

#endif

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/evaluate/descend_avx2.ipp"
#endif
