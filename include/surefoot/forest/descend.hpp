// From inputs to leaves: the hottest loops of the library. No branch depends on the inputs except the end of a loop,
// and eight descents are in flight at a time, enough to hide the latency of a load and few enough for the registers.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "surefoot/forest/descend_avx2.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

constexpr std::size_t lanes = 8;

/// Moves every node with `move(node, lane)` (which says how far) until none moves any more. The nodes are named one by
/// one, and not kept in an array, so that compilers keep them in registers.
template <class Move, class... Nodes>
[[gnu::always_inline]] inline void move_all(const Move& move, Nodes&... node) {
  std::size_t moved = 0;
  do {
    std::size_t lane = 0;
    moved = 0;
    (
        [&]() __attribute__((always_inline)) {
          const std::size_t distance = move(node, lane++);
          node += distance;
          moved |= distance;
        }(),
        ...);
  } while (moved != 0);
}

/// Eight descents: from first(lane), by move(node, lane); the ends go to last(lane, node).
template <class First, class Move, class Last>
[[gnu::always_inline]] inline void descend(const First& first, const Move& move, const Last& last) {
  const Node* a = first(0);
  const Node* b = first(1);
  const Node* c = first(2);
  const Node* d = first(3);
  const Node* e = first(4);
  const Node* f = first(5);
  const Node* g = first(6);
  const Node* h = first(7);
  move_all(move, a, b, c, d, e, f, g, h);
  last(0, a);
  last(1, b);
  last(2, c);
  last(3, d);
  last(4, e);
  last(5, f);
  last(6, g);
  last(7, h);
}

/// Sort keys shifted up by 32 bits, as Node::step wants them; the slot behind the last is 0.
inline void widen_keys(std::span<const std::uint32_t> keys, std::uint64_t* wide_keys) {
  for (const std::uint32_t key : keys) *wide_keys++ = std::uint64_t{key} << 32;
  *wide_keys = 0;
}

inline void find_leaves_portable(const Node* nodes, std::span<const std::uint32_t> roots,
                                 std::span<const std::uint32_t> keys, std::uint32_t* payloads) {
  std::array<std::uint64_t, max_forest_inputs + 1> wide_keys;
  widen_keys(keys, wide_keys.data());
  for (std::size_t tree = 0; tree < roots.size(); tree += lanes) {
    const std::size_t last = std::min(lanes, roots.size() - tree) - 1;
    descend([&](std::size_t lane) { return nodes + roots[tree + std::min(lane, last)]; },
            [&](const Node* node, std::size_t) { return node->step(wide_keys.data()); },
            [&](std::size_t lane, const Node* node) { payloads[tree + std::min(lane, last)] = node->payload(); });
  }
}

/// The payload of the leaf that one input, given by its sort keys, reaches in each tree.
inline void find_leaves(const Node* nodes, std::span<const std::uint32_t> roots, std::span<const std::uint32_t> keys,
                        std::uint32_t* payloads) {
#ifdef SUREFOOT_AVX2
  if (keys.size() < avx2_slots && __builtin_cpu_supports("avx2")) return find_leaves_avx2(nodes, roots, keys, payloads);
#endif
  find_leaves_portable(nodes, roots, keys, payloads);
}

/// Where in each tree the paths of inputs between two corners part at the latest; they all pass there.
inline void find_parting(const Node* nodes, std::span<const std::uint32_t> roots, const std::uint64_t* low_keys,
                         const std::uint64_t* high_keys, const Node** partings) {
  for (std::size_t tree = 0; tree < roots.size(); tree += lanes) {
    const std::size_t last = std::min(lanes, roots.size() - tree) - 1;
    descend([&](std::size_t lane) { return nodes + roots[tree + std::min(lane, last)]; },
            [&](const Node* node, std::size_t) {
              const std::size_t step = node->step(low_keys);
              return step == node->step(high_keys) ? step : 0;
            },
            [&](std::size_t lane, const Node* node) { partings[tree + std::min(lane, last)] = node; });
  }
}

/// The payload of the leaf that each of `count` inputs reaches from `start`; their wide keys lie `stride` apart. Works
/// on whole groups of lanes: keys and payloads must have room (and keys zeros) for up to lanes - 1 inputs more.
template <std::size_t FixedStride>
inline void find_leaves_of_batch(const Node* start, const std::uint64_t* wide_keys, std::size_t run_time_stride,
                                 std::size_t count, std::uint32_t* payloads) {
  const std::size_t stride = FixedStride != 0 ? FixedStride : run_time_stride;
  for (std::size_t sample = 0; sample < count; sample += lanes, wide_keys += lanes * stride, payloads += lanes) {
    descend([&](std::size_t) { return start; },
            [&](const Node* node, std::size_t lane) { return node->step(wide_keys + lane * stride); },
            [&](std::size_t lane, const Node* node) { payloads[lane] = node->payload(); });
  }
}

}  // namespace surefoot::detail
