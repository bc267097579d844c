#include "surefoot/forest/descend.hpp"

#include <doctest/doctest.h>

#include <array>
#include <limits>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

TEST_CASE("all ways down a tree end in the same leaf") {
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 2000, 1), {.trees = 70, .min_leaf = 1}, Serial{}, 1);
  const Trees& trees = forest.raw();
  Rng rng(2);
  std::vector<std::array<std::uint32_t, 5>> queries(300);
  for (auto& keys : queries) {
    for (std::uint32_t& key : keys) key = sort_key(static_cast<float>(rng.uniform(-1.2, 1.2)));
  }
  queries[0].fill(0);  // below every threshold
  queries[1].fill(sort_key(std::numeric_limits<float>::infinity()));
  queries[2][3] = trees.nodes[trees.roots[0]].key();  // on a threshold
  std::vector<std::uint64_t> wide_keys(304 * 6, 0);
  for (std::size_t i = 0; i < queries.size(); ++i) detail::widen_keys(queries[i], &wide_keys[6 * i]);

  int differences = 0;
  std::vector<std::uint32_t> portable(70);
  std::vector<std::vector<std::uint32_t>> by_tree(70, std::vector<std::uint32_t>(304));
  for (std::size_t t = 0; t < 70; ++t) {
    const Node* root = trees.nodes.data() + trees.roots[t];
    detail::find_leaves_of_batch<0>(root, wide_keys.data(), 6, queries.size(), by_tree[t].data());
  }
  for (std::size_t i = 0; i < queries.size(); ++i) {
    detail::find_leaves_portable(trees.nodes.data(), trees.roots, queries[i], portable.data());
    for (std::size_t t = 0; t < 70; ++t) differences += by_tree[t][i] != portable[t] ? 1 : 0;
#ifdef SUREFOOT_AVX2
    if (__builtin_cpu_supports("avx2")) {
      for (const std::size_t count : {1U, 8U, 16U, 17U, 32U, 33U, 70U}) {
        std::vector<std::uint32_t> vectorised(count);
        detail::find_leaves_avx2(trees.nodes.data(), std::span(trees.roots).first(count), queries[i],
                                 vectorised.data());
        for (std::size_t t = 0; t < count; ++t) differences += vectorised[t] != portable[t] ? 1 : 0;
      }
    }
#endif
  }
  CHECK(differences == 0);
}

TEST_CASE("inputs between two corners pass where their paths part") {
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 2000, 1), {.trees = 9, .min_leaf = 1}, Serial{}, 1);
  const Trees& trees = forest.raw();
  Rng rng(3);
  double shared = 0;
  for (int query = 0; query < 100; ++query) {
    std::array<std::array<float, 5>, 3> x;  // low, high, and one between
    for (std::size_t k = 0; k < 5; ++k) {
      x[0][k] = static_cast<float>(rng.uniform(-1, 1));
      x[1][k] = x[0][k] + 0.1F;
      x[2][k] = x[0][k] + static_cast<float>(rng.uniform(0, 0.1));
    }
    std::array<std::array<std::uint64_t, 6>, 3> wide_keys{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 5; ++k) wide_keys[i][k] = std::uint64_t{sort_key(x[i][k])} << 32;
    }
    std::array<const Node*, 9> partings;
    detail::find_parting(trees.nodes.data(), trees.roots, wide_keys[0].data(), wide_keys[1].data(), partings.data());
    for (std::size_t t = 0; t < 9; ++t) {
      const Node* node = trees.nodes.data() + trees.roots[t];
      int steps = 0;
      while (node != partings[t] && !node->is_leaf()) {
        node += node->step(wide_keys[2].data());
        ++steps;
      }
      REQUIRE(node == partings[t]);
      CHECK((node->is_leaf() || node->step(wide_keys[0].data()) != node->step(wide_keys[1].data())));
      shared += steps / 900.0;
    }
  }
  CHECK(shared > 1);  // worth its name
}

}  // namespace
}  // namespace surefoot
