// The descent from inputs to leaves: the hottest loops of the library. No branch depends on the inputs except the end
// of a loop, and eight descents are in flight at a time, enough to hide the latency of a load and few enough for the
// registers.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "surefoot/forest/evaluate/descend_avx2.hpp"
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

/// Moves every node `steps` times.
template <class Move, class... Nodes>
[[gnu::always_inline]] inline void move_some(std::size_t steps, const Move& move, Nodes&... node) {
  for (; steps > 0; --steps) {
    std::size_t lane = 0;
    ((node += move(node, lane++)), ...);
  }
}

/// Eight descents: from first(lane), by move(node, lane); the ends go to last(lane, node). To the leaves, or only so
/// many steps.
template <bool ToLeaves = true, class First, class Move, class Last>
[[gnu::always_inline]] inline void descend(const First& first, const Move& move, const Last& last,
                                           std::size_t steps = 0) {
  const Node* a = first(0);
  const Node* b = first(1);
  const Node* c = first(2);
  const Node* d = first(3);
  const Node* e = first(4);
  const Node* f = first(5);
  const Node* g = first(6);
  const Node* h = first(7);
  if constexpr (ToLeaves) {
    move_all(move, a, b, c, d, e, f, g, h);
  } else {
    move_some(steps, move, a, b, c, d, e, f, g, h);
  }
  last(0, a);
  last(1, b);
  last(2, c);
  last(3, d);
  last(4, e);
  last(5, f);
  last(6, g);
  last(7, h);
}

/// Calls take(tree, leaf) for each tree, with the leaf that one input, given by its wide keys, reaches there.
template <class Take>
inline void find_leaves_portable(const Node* nodes, std::span<const std::uint32_t> roots,
                                 std::span<const std::uint64_t> keys, const Take& take) {
  const auto move = [&](const Node* node, std::size_t = 0) { return node->step(keys.data()); };
  for (std::size_t tree = 0; tree < roots.size(); tree += lanes) {
    const std::size_t last = std::min(lanes, roots.size() - tree) - 1;
    if (last == 0) {  // alone it is faster
      const Node* node = nodes + roots[tree];
      move_all(move, node);
      take(tree, node);
    } else {
      descend([&](std::size_t lane) { return nodes + roots[tree + std::min(lane, last)]; }, move,
              [&](std::size_t lane, const Node* node) { take(tree + std::min(lane, last), node); });
    }
  }
}

constexpr std::size_t most_in_flight = 64;                                 // trees that find_leaves_far can take
constexpr std::size_t far_nodes = (std::size_t{2} << 20U) / sizeof(Node);  // a forest of more is beyond the caches near
                                                                           // the core (0.5 to 2 MB today)

#ifdef SUREFOOT_AVX2
/// Whether AVX2 can take so many trees down, and is faster: half of the lanes filled or fewer, eight at a time are.
inline bool avx2_pays(std::size_t trees, std::size_t slots) {
  return trees > avx2_trees / 2 && slots <= avx2_slots && __builtin_cpu_supports("avx2") != 0;
}
#endif

/// The indices of the nodes that one input, given by its wide keys, reaches in so many steps from each root. There is
/// room for most_in_flight of them.
inline void take_steps(const Node* nodes, std::span<const std::uint32_t> roots, std::span<const std::uint64_t> keys,
                       std::size_t steps, std::uint32_t* reached) {
#ifdef SUREFOOT_AVX2
  static_assert(most_in_flight % avx2_trees == 0);
  if (avx2_pays(roots.size(), keys.size())) return take_steps_avx2(nodes, roots, keys, steps, reached);
#endif
  for (std::size_t tree = 0; tree < roots.size(); tree += lanes) {
    const std::size_t last = std::min(lanes, roots.size() - tree) - 1;
    descend<false>([&](std::size_t lane) { return nodes + roots[tree + std::min(lane, last)]; },
                   [&](const Node* node, std::size_t) { return node->step(keys.data()); },
                   [&](std::size_t lane, const Node* node) {
                     reached[tree + std::min(lane, last)] = static_cast<std::uint32_t>(node - nodes);
                   },
                   steps);
  }
}

/// One step from a node, without a jump, which would be guessed wrong half of the time; the node it ends at is fetched.
inline const Node* step_and_fetch(const Node* node, std::span<const std::uint64_t> keys) {
  std::size_t distance = node->step(keys.data());
  asm("" : "+r"(distance));
  __builtin_prefetch(node + distance);
  return node + distance;
}

/// As find_leaves, for at most most_in_flight trees that lie far from the core. Down to the depth of a balanced tree
/// all of them go side by side. From there every tree takes a step in turn, and the node it comes to is fetched until
/// it is its turn again: as many fetches are in flight as trees go on, and none waits for another, while a vector of
/// lanes waits for the slowest of them at every step. Trees that have come to a leaf are left out after each round.
inline void find_leaves_far(std::span<const Node> all, std::span<const std::uint32_t> roots,
                            std::span<const std::uint64_t> keys, std::uint32_t* payloads) {
  constexpr std::size_t turns = 3;  // in a round; leaving a tree out costs about as much as two steps of it
  const std::size_t leaves = all.size() / roots.size() / 2;  // of a tree
  const auto balanced_depth = static_cast<std::size_t>(std::bit_width(leaves | 1) - 1);
  std::array<std::uint32_t, most_in_flight> reached;
  take_steps(all.data(), roots, keys, balanced_depth, reached.data());
  std::array<const Node*, most_in_flight> place;
  std::array<std::uint32_t, most_in_flight> tree;  // of each place
  for (std::size_t i = 0; i < roots.size(); ++i) {
    place[i] = all.data() + reached[i];
    tree[i] = static_cast<std::uint32_t>(i);
    __builtin_prefetch(place[i]);
  }
  for (std::size_t underway = roots.size(); underway > 0;) {
    for (std::size_t turn = 1; turn < turns; ++turn) {
      for (std::size_t i = 0; i < underway; ++i) place[i] = step_and_fetch(place[i], keys);
    }
    const std::size_t count = std::exchange(underway, 0);
    for (std::size_t i = 0; i < count; ++i) {
      const Node* before = place[i];
      const Node* now = step_and_fetch(before, keys);
      const std::uint32_t at = tree[i];
      payloads[at] = now->payload();  // of a leaf, once it is one
      place[underway] = now;
      tree[underway] = at;
      underway += now != before ? 1 : 0;
    }
  }
}

/// The payload of the leaf that one input, given by its wide keys, reaches in each tree.
inline void find_leaves(std::span<const Node> all, std::span<const std::uint32_t> roots,
                        std::span<const std::uint64_t> keys, std::uint32_t* payloads) {
  const Node* nodes = all.data();
  if (all.size() > far_nodes && roots.size() <= most_in_flight) return find_leaves_far(all, roots, keys, payloads);
#ifdef SUREFOOT_AVX2
  if (avx2_pays(roots.size(), keys.size())) {
    const std::size_t rest =
        roots.size() % avx2_trees;  // half of the lanes filled or fewer: eight at a time are faster
    const std::size_t vectorised = rest > avx2_trees / 2 ? roots.size() : roots.size() - rest;
    find_leaves_avx2(nodes, roots.first(vectorised), keys, payloads);
    roots = roots.subspan(vectorised);
    payloads += vectorised;
  }
#endif
  if (roots.empty()) return;
  find_leaves_portable(nodes, roots, keys,
                       [&](std::size_t tree, const Node* leaf) { payloads[tree] = leaf->payload(); });
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

}  // namespace surefoot::detail
