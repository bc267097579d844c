#include "surefoot/forest/evaluate/descend.hpp"

#include <doctest/doctest.h>

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/evaluate/descend_batch.hpp"
#include "surefoot/forest/evaluate/descend_blocks.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

// Every input of many matters: with the slot behind them more keys than one register of AVX2 holds.
struct Waves {
  static constexpr int inputs = 15, outputs = 1;
  Vec<1> operator()(const Vec<15>& x) const { return Vec<1>((3 * x.array() + x[0]).sin().sum()); }
};

template <std::size_t Inputs>
using Query = std::array<float, Inputs>;

template <std::size_t Inputs>
std::vector<Query<Inputs>> hard_queries(const Trees& trees, std::size_t count) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  Rng rng(2);
  std::vector<Query<Inputs>> queries(count);
  for (Query<Inputs>& x : queries) {
    for (float& value : x) value = static_cast<float>(rng.uniform(-1.2, 1.2));
    switch (rng.below(8)) {  // half of them as they are
      case 0:
        x[rng.below(Inputs)] = nan;
        break;
      case 1:
        x[rng.below(Inputs)] = rng.below(2) == 0 ? infinity : -infinity;
        break;
      case 2:
        x[rng.below(Inputs)] = rng.below(2) == 0 ? 0.0F : -0.0F;
        break;
      case 3: {  // on a threshold
        const Node node = trees.nodes[rng.below(static_cast<std::uint32_t>(trees.nodes.size()))];
        if (!node.is_leaf()) x[static_cast<std::size_t>(node.input())] = node.threshold();
        break;
      }
      default:
        break;
    }
  }
  queries[0].fill(nan);
  queries[1].fill(infinity);
  queries[2].fill(-infinity);
  queries[3].fill(-0.0F);
  return queries;
}

// One comparison of floats after the other.
template <std::size_t Inputs>
std::uint32_t payload_by_hand(const Trees& trees, std::size_t tree, const Query<Inputs>& x) {
  std::size_t at = trees.roots[tree];
  while (!trees.nodes[at].is_leaf()) {
    const Node node = trees.nodes[at];
    at += node.distance() + (x[static_cast<std::size_t>(node.input())] > node.threshold() ? 1U : 0U);
  }
  return trees.nodes[at].payload();
}

TEST_CASE_TEMPLATE("all ways down a tree end in the same leaf", Function, toy::Cliff, Waves) {
  constexpr std::size_t inputs = Function::inputs;
  for (const int min_leaf : {1, 20, 2000}) {  // of the last each tree is one leaf
    CAPTURE(min_leaf);
    const auto forest =
        train_extra_trees(toy::sample(Function{}, 2000, 1), {.trees = 70, .min_leaf = min_leaf}, Serial{}, 1);
    const Trees& trees = forest.raw();
    const std::vector<Query<inputs>> queries = hard_queries<inputs>(trees, detail::max_batch);
    std::vector<std::vector<std::uint32_t>> expected(queries.size(), std::vector<std::uint32_t>(70));
    for (std::size_t i = 0; i < queries.size(); ++i) {
      for (std::size_t t = 0; t < 70; ++t) expected[i][t] = payload_by_hand(trees, t, queries[i]);
    }

    const detail::Blocks blocks = detail::make_blocks(trees);
    int differences = 0;
    std::vector<std::uint64_t> rows;
    std::vector<std::int32_t> columns((inputs + 1) * detail::max_batch, detail::flipped(0));
    for (std::size_t i = 0; i < queries.size(); ++i) {
      std::array<std::uint64_t, inputs + 1> keys{};
      for (std::size_t k = 0; k < inputs; ++k) {
        keys[k] = wide_key(queries[i][k]);
        columns[k * detail::max_batch + i] = detail::flipped(sort_key(queries[i][k]));
      }
      rows.insert(rows.end(), keys.begin(), keys.end());
      for (const std::size_t count : {1U, 2U, 7U, 8U, 9U, 15U, 16U, 17U, 25U, 32U, 33U, 48U, 49U, 64U, 65U, 70U}) {
        const auto roots = std::span(trees.roots).first(count);
        std::vector<std::uint32_t> found(count, 1);
        const auto compare = [&] {
          for (std::size_t t = 0; t < count; ++t) differences += found[t] != expected[i][t] ? 1 : 0;
          found.assign(count, 1);
        };
        detail::find_leaves(std::span<const Node>(trees.nodes), roots, keys, found.data());
        compare();
        detail::find_leaves_portable(trees.nodes.data(), roots, keys,
                                     [&](std::size_t t, const Node* leaf) { found[t] = leaf->payload(); });
        compare();
        if (count <= detail::most_in_flight) {
          detail::find_leaves_far(std::span<const Node>(trees.nodes), roots, keys, found.data());
          compare();
        }
#ifdef SUREFOOT_AVX2
        if (__builtin_cpu_supports("avx2")) {
          detail::find_leaves_avx2(trees.nodes.data(), roots, keys, found.data());
          compare();
        }
        if (detail::can_descend_blocks() && count <= detail::most_in_flight) {
          detail::find_leaves_in_blocks(blocks.blocks, std::span(blocks.roots).first(count), keys, found.data());
          compare();
        }
#endif
      }
    }
    const detail::BatchKeys keys{rows.data(), inputs + 1, columns.data(), detail::max_batch};
    for (const std::size_t count : {8U, 16U, 40U, 256U}) {
      for (std::size_t t = 0; t < 70; ++t) {
        const Node* root = trees.nodes.data() + trees.roots[t];
        std::array<std::uint32_t, detail::max_batch> fixed;
        std::array<std::uint32_t, detail::max_batch> run_time;
        detail::find_leaves_of_batch<inputs + 1>(root, keys, count, fixed.data());
        detail::find_leaves_of_batch<0>(root, keys, count, run_time.data());
        for (std::size_t i = 0; i < count; ++i) {
          differences += fixed[i] != expected[i][t] || run_time[i] != expected[i][t] ? 1 : 0;
        }
      }
    }
    CHECK(differences == 0);
  }
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
      for (std::size_t k = 0; k < 5; ++k) wide_keys[i][k] = wide_key(x[i][k]);
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
