// The descent of many inputs through one tree. Its first three levels take no jumps: every input is compared with all
// seven nodes, input after input in one row of memory, which compilers vectorise. Then eight descents are in flight at
// a time, in rounds of a few steps: after each, only those that are not in a leaf yet go on, so that no short path
// waits for a long one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "surefoot/forest/evaluate/descend.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

constexpr std::size_t max_batch = 256;  // inputs that go through a tree together

/// The sort keys of a batch, in two orders. The slot behind the last input counts as one of them; its keys are 0.
struct BatchKeys {
  const std::uint64_t* rows;    // shifted up by 32 bits, input after input; `stride` for each
  std::size_t stride;           // number of slots
  const std::int32_t* columns;  // top bit flipped (so that they sort as signed), slot after slot; `length` for each
  std::size_t length;           // at least the number of inputs
};

/// The top bit flipped: sorts as signed as the key does unsigned.
constexpr std::int32_t flipped(std::uint32_t key) { return static_cast<std::int32_t>(key ^ 0x80000000U); }

/// Where the first `count` inputs are three levels below `start` (or in a leaf above).
inline void descend_three_levels(const Node* start, const BatchKeys& keys, std::size_t count, const Node** places) {
  std::array<const Node*, 15> tree{start};  // the children of i are 2 i + 1 and 2 i + 2, those of a leaf itself
  std::array<std::int32_t, 7> threshold;
  std::array<const std::int32_t*, 7> key;
  for (std::size_t i = 0; i < 7; ++i) {
    const Node* node = tree[i];
    threshold[i] = flipped(node->key());
    key[i] = keys.columns + static_cast<std::size_t>(node->input()) * keys.length;
    tree[2 * i + 1] = node + node->distance();
    tree[2 * i + 2] = tree[2 * i + 1] + (node->is_leaf() ? 0 : 1);
  }

  std::array<std::int32_t, max_batch> end;  // index in `tree`
  for (std::size_t i = 0; i < count; ++i) {
    const auto right = [&](std::size_t node) { return key[node][i] > threshold[node] ? -1 : 0; };  // a mask
    const auto choose = [](int mask, int if_set, int if_not) { return (mask & if_set) | (~mask & if_not); };
    const int first = right(0);
    const int second = choose(first, right(2), right(1));
    const int third = choose(first, choose(second, right(6), right(5)), choose(second, right(4), right(3)));
    end[i] = 7 - (4 * first + 2 * second + third);
  }
  for (std::size_t i = 0; i < count; ++i) places[i] = tree[static_cast<std::uint32_t>(end[i])];
}

/// Inputs on their way down.
struct Underway {
  std::array<const Node*, max_batch> place;
  std::array<std::uint16_t, max_batch> sample;  // which input of the batch
};

/// Goes `steps` steps on with entries [begin, end) of the list, whole groups of lanes. Those that are not in a leaf
/// then are listed from entry 0 on; returns their number. InOrder: entry i is input i, whatever the list says.
template <bool InOrder>
[[gnu::always_inline]] inline std::size_t go_on(const std::uint64_t* rows, std::size_t stride, Underway& list,
                                                std::size_t begin, std::size_t end, std::size_t steps,
                                                std::uint32_t* payloads) {
  std::size_t left = 0;
  for (std::size_t at = begin; at < end; at += lanes) {
    std::array<std::size_t, lanes> sample;
    for (std::size_t lane = 0; lane < lanes; ++lane) sample[lane] = InOrder ? at + lane : list.sample[at + lane];
    std::array<const std::uint64_t*, lanes> row;
    for (std::size_t lane = 0; lane < lanes; ++lane) row[lane] = rows + sample[lane] * stride;
    descend<false>([&](std::size_t lane) { return list.place[at + lane]; },
                   [&](const Node* node, std::size_t lane) { return node->step(row[lane]); },
                   [&](std::size_t lane, const Node* node) {
                     payloads[sample[lane]] = node->payload();
                     list.place[left] = node;
                     list.sample[left] = static_cast<std::uint16_t>(sample[lane]);
                     left += node->is_leaf() ? 0 : 1;
                   },
                   steps);
  }
  return left;
}

/// The payload of the leaf that each of `count` inputs (1 to max_batch) reaches from `start`. Works on whole groups of
/// lanes: keys and payloads must have room (and keys zeros) for up to lanes - 1 inputs more.
template <std::size_t FixedStride>
inline void find_leaves_of_batch(const Node* start, const BatchKeys& keys, std::size_t count, std::uint32_t* payloads) {
  constexpr std::size_t steps_per_round = 3;
  const std::size_t stride = FixedStride != 0 ? FixedStride : keys.stride;
  const std::size_t padded = (count + lanes - 1) / lanes * lanes;
  Underway list;
  descend_three_levels(start, keys, padded, list.place.data());

  std::size_t steps = 0;  // that the first group takes to its leaves; most of the others will take 5/8 of that
  descend([&](std::size_t lane) { return list.place[lane]; },
          [&](const Node* node, std::size_t lane) {
            steps += lane == 0 ? 1 : 0;
            return node->step(keys.rows + lane * stride);
          },
          [&](std::size_t lane, const Node* node) { payloads[lane] = node->payload(); });
  std::size_t left = go_on<true>(keys.rows, stride, list, lanes, padded, steps * 5 / 8, payloads);
  while (left > 0) {
    std::size_t end = left;
    for (; end % lanes != 0; ++end) {  // the last one fills its group up
      list.place[end] = list.place[left - 1];
      list.sample[end] = list.sample[left - 1];
    }
    left = go_on<false>(keys.rows, stride, list, 0, end, steps_per_round, payloads);
  }
}

}  // namespace surefoot::detail
