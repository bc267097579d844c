#include "surefoot/forest/prune.hpp"

#include <doctest/doctest.h>

#include <array>
#include <numeric>
#include <set>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

template <class F>
Forest<1, 1, ConstantLeaf> staircase(const F& samples) {
  return train_extra_trees(samples, {.trees = 1, .min_leaf = 1}, Serial{}, 1);
}

// Four steps of one input: two nearly equal, one apart, one far apart.
Dataset<1, 1> pruned_steps() {
  Dataset<1, 1> samples{Eigen::Matrix<float, 1, 8>{1, 1, 2, 2, 3, 3, 4, 4},
                        Eigen::Matrix<double, 1, 8>{0, 0, 0.5, 0.5, 10, 10, 13, 13},
                        {}};
  return samples;
}

TEST_CASE("trees taken out and put back predict the same") {
  const auto forest = train_extra_trees<LinearLeaf>(toy::sample(toy::ClippedLaws{}, 800, 1), {.trees = 5}, Serial{}, 1);
  std::vector<std::size_t> all(5);
  std::iota(all.begin(), all.end(), 0U);
  const auto kept = keep_trees(forest, std::span<const std::size_t>(all));
  const auto test = toy::sample(toy::ClippedLaws{}, 300, 2);
  Eigen::Matrix<double, 2, Eigen::Dynamic> expected, predicted;
  forest.predict(test.inputs, expected);
  kept.predict(test.inputs, predicted);
  CHECK(predicted == expected);
  CHECK(kept.leaves() == forest.leaves());
}

TEST_CASE("a forest of one tree predicts what that tree adds") {
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 800, 1), {.trees = 3}, Serial{}, 1);
  const auto test = toy::sample(toy::Cliff{}, 50, 2);
  for (Eigen::Index i = 0; i < 50; ++i) {
    const Vec<5> x = test.inputs.col(i).cast<double>();
    double mean = 0;
    for (std::size_t tree = 0; tree < 3; ++tree) {
      mean += keep_trees(forest, std::span<const std::size_t>(&tree, 1)).predict(x)[0] / 3;
    }
    CHECK(mean == doctest::Approx(forest.predict(x)[0]).epsilon(1e-12));
  }
}

TEST_CASE("the best trees are better than the first") {
  const auto forest =
      train_extra_trees(toy::sample(toy::Cliff{}, 2000, 1), {.trees = 30, .candidates = 1}, Serial{}, 1);
  const auto ours = toy::sample(toy::Cliff{}, 2000, 2);
  const auto fresh = toy::sample(toy::Cliff{}, 2000, 3);
  const std::vector<std::size_t> best = best_trees(forest, ours, 5);
  CHECK(std::set<std::size_t>(best.begin(), best.end()).size() == 5);
  const std::vector<std::size_t> fewer = best_trees(forest, ours, 2);
  CHECK(std::equal(fewer.begin(), fewer.end(), best.begin()));
  const std::array<std::size_t, 5> first{0, 1, 2, 3, 4};
  CHECK(fraction_of_variance_unexplained(keep_trees(forest, std::span<const std::size_t>(best)), fresh) <
        0.95 * fraction_of_variance_unexplained(keep_trees(forest, std::span<const std::size_t>(first)), fresh));
}

TEST_CASE("the weakest link goes first") {
  const auto samples = pruned_steps();
  const auto forest = staircase(samples);
  REQUIRE(forest.leaves() == 4);
  const std::vector<double> scale{1.0};
  auto [tree, order] = detail::weakest_links(detail::leaf_kind<ConstantLeaf>(), detail::loosen(forest.raw(), 0),
                                             detail::view_of(samples), scale, {});
  double costs = 0;
  std::size_t saved = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0) CHECK(order[i].cost >= order[i - 1].cost);
    costs += order[i].cost * static_cast<double>(order[i].leaves);
    saved += order[i].leaves;
  }
  CHECK(saved == 3);
  const Eigen::RowVectorXd y = samples.outputs;
  CHECK(costs == doctest::Approx((y.array() - y.mean()).square().sum()));  // all steps together: the root alone
  CHECK(order.back().node == 0);
  // Merging the steps at 0 and 0.5 costs 4 * 0.25^2, if the tree has them as siblings; no other merge costs less.
  CHECK(order.front().cost >= 4 * 0.25 * 0.25 - 1e-12);
}

TEST_CASE("a pruned leaf is the mean of the samples there") {
  Dataset<1, 1> samples{Eigen::Matrix<float, 1, 4>{1, 2, 3, 4}, Eigen::Matrix<double, 1, 4>{1, 2, 7, 10}, {}};
  samples.weights = Eigen::Vector4d(1, 1, 1, 2);
  auto forest = staircase(samples);
  const std::size_t single = detail::tree_bytes(1, 1);
  auto more = forest.raw();
  for (int i = 0; i < 3; ++i) more.append(forest.raw());
  const Forest<1, 1> four(more);
  const auto pruned = prune(four, samples, 4 * single);  // 4 leaves fit into a cache line: it is small already
  CHECK(pruned == four);
  auto wide = toy::sample(toy::Cliff{}, 1000, 1);
  const auto large = train_extra_trees(wide, {.trees = 3}, Serial{}, 1);
  const auto stumps = prune(large, wide, 3 * single);
  CHECK(stumps.bytes() <= 3 * single);
  CHECK(stumps.leaves() >= 9);  // what fits into a line is used
  Dataset<5, 1> none = wide;
  none.outputs.setConstant(4.0);
  CHECK(prune(large, none, 3 * single).predict(Vec<5>::Zero())[0] == doctest::Approx(4.0).epsilon(0.5));
}

TEST_CASE("pruning meets every budget, and loses more the smaller it is") {
  const auto samples = toy::sample(toy::Cliff{}, 4000, 1, 0.2);
  const auto test = toy::sample(toy::Cliff{}, 4000, 2);
  const auto constant = train_extra_trees(samples, {.trees = 5, .min_leaf = 1}, Serial{}, 1);
  const auto linear = train_extra_trees<LinearLeaf>(samples, {.trees = 5, .min_leaf = 5}, Serial{}, 1);
  const auto check = [&](const auto& forest) {
    double before = 0;
    for (std::size_t bytes = forest.bytes() / 4; bytes > 1000; bytes /= 4) {
      const auto pruned = prune(forest, samples, bytes);
      CHECK(pruned.bytes() <= bytes);
      CHECK(pruned.bytes() > bytes - 400);
      CHECK(pruned.trees() == 5);
      const double error = fraction_of_variance_unexplained(pruned, test);
      CHECK(error > 0.9 * before);
      before = error;
    }
  };
  check(constant);
  check(linear);
}

TEST_CASE("pruning a fully grown tree takes noise out") {
  const auto samples = toy::sample(toy::Cliff{}, 4000, 1, 0.7);
  const auto others = toy::sample(toy::Cliff{}, 4000, 2, 0.7);
  const auto test = toy::sample(toy::Cliff{}, 4000, 3);
  const auto forest = train_extra_trees(samples, {.trees = 1, .min_leaf = 1}, Serial{}, 1);
  const auto pruned = prune(forest, others, forest.bytes() / 20);
  CHECK(fraction_of_variance_unexplained(pruned, test) < 0.5 * fraction_of_variance_unexplained(forest, test));
}

TEST_CASE("pruning gives the same forest for any executor") {
  const auto samples = toy::sample(toy::ClippedLaws{}, 1000, 1);
  const auto forest = train_extra_trees<LinearLeaf>(samples, {.trees = 4}, Serial{}, 1);
  CHECK(prune(forest, samples, 5000) == prune(forest, samples, 5000, {}, Threads(3)));
}

TEST_CASE("samples may miss parts of the tree, and weights count") {
  auto samples = toy::sample(toy::Cliff{}, 2000, 1);
  const auto forest = train_extra_trees<LinearLeaf>(samples, {.trees = 2, .min_leaf = 5}, Serial{}, 1);
  Dataset<5, 1> few{samples.inputs.leftCols(3), samples.outputs.leftCols(3), {}};
  CHECK(prune(forest, few, 2000).bytes() <= 2000);
  samples.weights = Eigen::VectorXd::Constant(2000, 1e-6);
  for (Eigen::Index i = 0; i < 2000; ++i) {
    if (samples.inputs(0, i) > 0) samples.weights[i] = 1;
  }
  const auto pruned = prune(forest, samples, 3000);
  CHECK(fraction_of_variance_unexplained(pruned, samples) <
        0.75 * fraction_of_variance_unexplained(prune(forest, toy::sample(toy::Cliff{}, 2000, 1), 3000), samples));
}

TEST_CASE("what cannot be pruned is named") {
  const auto samples = toy::sample(toy::Cliff{}, 100, 1);
  const auto forest = train_extra_trees(samples, {.trees = 4}, Serial{}, 1);
  CHECK_THROWS_WITH_AS(prune(forest, samples, 200), doctest::Contains("keep fewer trees"), ForestError);
  CHECK_THROWS_WITH_AS(prune(Forest<5, 1>(), samples, 200), doctest::Contains("empty"), ForestError);
  CHECK_THROWS_WITH_AS(best_trees(forest, samples, 5), doctest::Contains("1 to 4"), ForestError);
  const std::size_t ninth = 9;
  CHECK_THROWS_WITH_AS(keep_trees(forest, std::span<const std::size_t>(&ninth, 1)), doctest::Contains("no tree 9"),
                       ForestError);
  CHECK_THROWS_WITH_AS(keep_trees(forest, {}), doctest::Contains("at least one"), ForestError);
}

TEST_CASE("the unexplained share is 0 for perfect outputs and 1 for their mean") {
  Dataset<1, 1> samples{Eigen::Matrix<float, 1, 4>{1, 2, 3, 4}, Eigen::Matrix<double, 1, 4>{1, 2, 7, 10}, {}};
  CHECK(fraction_of_variance_unexplained(staircase(samples), samples) == 0);
  CHECK(fraction_of_variance_unexplained(train_extra_trees(samples, {.trees = 1, .min_leaf = 4}, Serial{}, 1),
                                         samples) == doctest::Approx(1));
}

}  // namespace
}  // namespace surefoot
