#include "surefoot/forest/evaluate/descend_blocks.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <type_traits>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/serialize.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

template <LeafModel Leaf>
Forest<5, 1, Leaf> forest_of(int trees, int min_leaf) {
  return train_extra_trees<Leaf>(toy::sample(toy::Cliff{}, 6000, 1), {.trees = trees, .min_leaf = min_leaf}, Serial{},
                                 1);
}

// A view has its nodes only.
template <LeafModel Leaf>
ForestView<5, 1, Leaf> without_blocks(const Forest<5, 1, Leaf>& forest) {
  const Trees& trees = forest.raw();
  TreesView view;
  static_cast<TreesShape&>(view) = trees;
  view.nodes = trees.nodes;
  view.roots = trees.roots;
  view.parameters = trees.parameters;
  return ForestView<5, 1, Leaf>(view);
}

TEST_CASE_TEMPLATE("a forest predicts the same bits through blocks as through nodes", Leaf, ConstantLeaf, LinearLeaf) {
  const int min_leaf = std::is_same_v<Leaf, LinearLeaf> ? 10 : 4;
  const auto forest = forest_of<Leaf>(70, min_leaf);  // more trees than go down together
  REQUIRE((detail::blocks_pay(forest.raw()) || !detail::can_descend_blocks()));
  const auto nodes = without_blocks(forest);
  const Forest<5, 1, Leaf> copy = forest;
  Rng rng(2);
  int differences = 0;
  for (int i = 0; i < 2000; ++i) {
    Vec<5> x;
    for (double& value : x) value = rng.uniform(-1.2, 1.2);
    if (i % 10 == 0 && std::is_same_v<Leaf, ConstantLeaf>) x[i / 10 % 5] = std::numeric_limits<double>::quiet_NaN();
    if (i % 10 == 1) x[i / 10 % 5] = 1e30;
    const auto expected = nodes.predict_with_deviation(x);
    const auto found = copy.predict_with_deviation(x);
    differences += found.mean != expected.mean || found.deviation != expected.deviation ? 1 : 0;
    differences += forest.predict(x) != nodes.predict(x) ? 1 : 0;
  }
  CHECK(differences == 0);
}

TEST_CASE("blocks are for large forests of more than eight trees and at most fifteen inputs") {
  if (!detail::can_descend_blocks()) return;
  Trees trees = forest_of<ConstantLeaf>(20, 2).raw();
  CHECK(detail::blocks_pay(trees));
  CHECK(!detail::blocks_pay(forest_of<ConstantLeaf>(20, 200).raw()));
  trees.inputs = 16;
  CHECK(!detail::blocks_pay(trees));
  trees.inputs = 15;
  CHECK(detail::blocks_pay(trees));
  trees.roots.resize(8);
  CHECK(!detail::blocks_pay(trees));
}

}  // namespace
}  // namespace surefoot
