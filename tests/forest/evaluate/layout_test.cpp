#include "surefoot/forest/evaluate/layout.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {
namespace {

// A random tree of 3 inputs whose leaves carry their own numbers.
std::vector<GrownNode> random_tree(int splits, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<GrownNode> tree(1);
  tree[0].count = 1U << 30;
  std::vector<std::uint32_t> leaves{0};
  for (int i = 0; i < splits; ++i) {
    const std::uint32_t at = rng.below(static_cast<std::uint32_t>(leaves.size()));
    const std::uint32_t node = leaves[at];
    const auto left = static_cast<std::uint32_t>(tree.size());
    tree.resize(tree.size() + 2);
    tree[node].left = left;
    tree[node].input = static_cast<int>(rng.below(3));
    tree[node].threshold = static_cast<float>(rng.normal());
    tree[left].count = static_cast<std::uint32_t>(rng.uniform() * tree[node].count);
    tree[left + 1].count = tree[node].count - tree[left].count;
    leaves[at] = left;
    leaves.push_back(left + 1);
  }
  for (std::size_t i = 0; i < tree.size(); ++i) tree[i].payload = static_cast<std::uint32_t>(i);
  return tree;
}

void check_same(const std::vector<GrownNode>& tree, std::uint32_t node, const NodeArray& nodes, std::size_t place) {
  const Node laid = nodes.at(place);
  REQUIRE(laid.is_leaf() == tree[node].is_leaf());
  if (laid.is_leaf()) {
    CHECK(laid.payload() == tree[node].payload);
    CHECK(laid.input() == 3);
    return;
  }
  CHECK(laid.input() == tree[node].input);
  CHECK(laid.threshold() == tree[node].threshold);
  const std::size_t child = place + laid.distance();
  CHECK(child % 2 == 0);
  check_same(tree, tree[node].left, nodes, child);
  check_same(tree, tree[node].left + 1, nodes, child + 1);
}

TEST_CASE("a laid out tree is the tree that grew") {
  for (const int splits : {0, 1, 2, 3, 4, 5, 7, 10, 50, 1000}) {
    const auto tree = random_tree(splits, static_cast<std::uint64_t>(splits));
    const NodeArray nodes = lay_out(tree, 3);
    CHECK(nodes.size() % nodes_per_line == 0);
    check_same(tree, 0, nodes, 0);
  }
}

TEST_CASE("a laid out tree takes hardly more room than its nodes") {
  const NodeArray nodes = lay_out(random_tree(5000, 3), 3);
  CHECK(nodes.size() < 10'001 * 102 / 100);
}

TEST_CASE("a descent touches far fewer cache lines than it takes steps") {
  const auto tree = random_tree(5000, 4);
  const NodeArray nodes = lay_out(tree, 3);
  struct Visit {
    std::uint32_t grown;
    std::size_t place;
    double steps, lines;
  };
  double steps = 0;  // mean over samples, weighted by how many reach each leaf
  double lines = 0;
  std::vector<Visit> open{{0, 0, 0, 1}};
  while (!open.empty()) {
    const Visit v = open.back();
    open.pop_back();
    if (tree[v.grown].is_leaf()) {
      steps += v.steps * tree[v.grown].count;
      lines += v.lines * tree[v.grown].count;
      continue;
    }
    const std::size_t child = v.place + nodes[v.place].distance();
    const double next_lines = v.lines + (child / nodes_per_line != v.place / nodes_per_line ? 1 : 0);
    open.push_back({tree[v.grown].left, child, v.steps + 1, next_lines});
    open.push_back({tree[v.grown].left + 1, child + 1, v.steps + 1, next_lines});
  }
  CHECK(lines < 0.6 * steps);
}

TEST_CASE("sort keys order floats as they are, zeros alike, NaN below all") {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> ascending{-infinity, -3e38F, -1.5F, -1e-45F, 0.0F, 1e-45F, 1.0F, 1.5F, 3e38F, infinity};
  for (std::size_t i = 0; i < ascending.size(); ++i) {
    for (std::size_t j = 0; j < ascending.size(); ++j) {
      CHECK((sort_key(ascending[i]) < sort_key(ascending[j])) == (ascending[i] < ascending[j]));
    }
    CHECK(from_sort_key(sort_key(ascending[i])) == ascending[i]);
    CHECK(sort_key(std::numeric_limits<float>::quiet_NaN()) < sort_key(ascending[i]));
  }
  CHECK(sort_key(-0.0F) == sort_key(0.0F));
}

}  // namespace
}  // namespace surefoot::detail
