// Forests of short floats: thresholds and leaves rounded to 11 significant bits, which a C file with text tables
// spells in three characters instead of five.
#pragma once

#include <bit>
#include <cstdint>
#include <utility>

#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot {

namespace detail {

/// Bits at the end of a float that short floats have at 0: 10 of 23 bits of the fraction are left, and 85^3 > 2^19.
inline constexpr std::uint32_t dropped_bits = 13;

constexpr bool is_short(std::uint32_t bits) { return (bits & ((1U << dropped_bits) - 1)) == 0; }

/// The nearest short float, the even one of two; by at most 1 / 2048 of its size away.
constexpr float shortened(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t half = (1U << (dropped_bits - 1)) - 1 + ((bits >> dropped_bits) & 1U);
  return std::bit_cast<float>((bits + half) >> dropped_bits << dropped_bits);
}

}  // namespace detail

/// The forest with all thresholds and numbers of leaves shortened. Predictions move by about 1 / 2048 of the largest
/// summand of a leaf; right at a threshold, to the neighbouring leaf. Numbers must be finite.
template <int Inputs, int Outputs, LeafModel Leaf>
Forest<Inputs, Outputs, Leaf> with_short_floats(const Forest<Inputs, Outputs, Leaf>& forest) {
  Trees trees = forest.raw();
  for (Node& node : trees.nodes) {
    if (!node.is_leaf()) {
      node = Node::inner(node.input(), detail::shortened(node.threshold()), node.distance());
    } else if (trees.inline_leaves()) {
      const auto number = std::bit_cast<float>(node.payload());
      node = Node::leaf(trees.inputs, std::bit_cast<std::uint32_t>(detail::shortened(number)));
    }
  }
  for (float& number : trees.parameters) number = detail::shortened(number);
  return Forest<Inputs, Outputs, Leaf>(std::move(trees));
}

}  // namespace surefoot
