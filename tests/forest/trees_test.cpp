// Nodes and their sort keys.
#include "surefoot/forest/trees.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace surefoot {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

TEST_CASE("sort keys are in the order of the floats, and give them back") {
  constexpr std::array rising = {-infinity, -1e30F, -2.5F, -1e-40F, 0.0F, 1e-40F, 0.1F, 2.5F, 1e30F, infinity};
  for (std::size_t i = 0; i < rising.size(); ++i) {
    CHECK(from_sort_key(sort_key(rising[i])) == rising[i]);
    if (i > 0) CHECK(sort_key(rising[i - 1]) < sort_key(rising[i]));
  }
}

TEST_CASE("minus zero counts as zero, and no number as less than all numbers") {
  CHECK(sort_key(-0.0F) == sort_key(0.0F));
  CHECK(sort_key(std::nanf("")) < sort_key(-infinity));
}

TEST_CASE("an inner node goes left up to its threshold and right beyond it") {
  const Node node = Node::inner(1, 0.5F, 7);
  CHECK(node.input() == 1);
  CHECK(node.threshold() == 0.5F);
  CHECK_FALSE(node.is_leaf());
  const auto goes = [&](float value) {
    const std::array<std::uint64_t, 3> keys = {wide_key(9), wide_key(value), 0};
    return node.step(keys.data());
  };
  CHECK(goes(0.5F) == 7);
  CHECK(goes(std::nextafter(0.5F, 1.0F)) == 8);
  CHECK(goes(std::nanf("")) == 7);
}

TEST_CASE("a leaf leads to itself and keeps its payload") {
  const Node leaf = Node::leaf(2, 0xFFFFFFFFU);
  CHECK(leaf.is_leaf());
  CHECK(leaf.payload() == 0xFFFFFFFFU);
  const std::array<std::uint64_t, 3> keys = {wide_key(infinity), wide_key(infinity), 0};
  CHECK(leaf.step(keys.data()) == 0);
}

TEST_CASE("nodes start with a cache line, and where there are many with a large page") {
  const auto offset = [](const NodeArray& nodes, std::size_t from) {
    return reinterpret_cast<std::uintptr_t>(nodes.data()) % from;
  };
  for (const std::size_t count : {1U, 1000U}) CHECK(offset(NodeArray(count), detail::cache_line) == 0);
  NodeArray many(2 * detail::large_page / sizeof(Node), Node::leaf(3, 7));
  CHECK(offset(many, detail::large_page) == 0);
  many.push_back(Node::leaf(3, 8));
  CHECK(many.front() == Node::leaf(3, 7));
  CHECK(many.back() == Node::leaf(3, 8));
}

}  // namespace
}  // namespace surefoot
