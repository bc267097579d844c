#include "surefoot/forest/permutation_importance.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

TEST_CASE("shuffling costs what an input explains, twice over, and nothing if it has no influence") {
  const auto forest = train_extra_trees<LinearLeaf>(toy::sample(toy::Cliff{}, 6000, 1), {.min_leaf = 20}, Threads{}, 1);
  const auto test = toy::sample(toy::Cliff{}, 4000, 2);
  const auto importance = permutation_importance(forest, test, Threads{}, 1);
  const double variance = (test.outputs.array() - test.outputs.mean()).square().mean();
  // A shuffled part of the sum is off by the difference of two draws: twice its variance.
  CHECK(importance.mean[3] == doctest::Approx(2 * 4 * 0.6 * 0.4 / variance).epsilon(0.06));
  const double sine = 0.5 - std::sin(6.0) / 12;  // mean square of sin(3 x) over [-1, 1]
  CHECK(importance.mean[0] == doctest::Approx(2 * sine / variance).epsilon(0.06));
  CHECK(importance.mean[1] > 0.02);
  CHECK(std::abs(importance.mean[4]) < 0.002);
  CHECK(importance.deviation[3] > 0);
  CHECK(importance.deviation[3] < 0.05 * importance.mean[3]);
}

TEST_CASE("permutations depend on the seed and not on the threads") {
  const auto samples = toy::sample(toy::ClippedLaws{}, 1000, 1);
  const auto forest = train_extra_trees(samples, {.trees = 5}, Serial{}, 1);
  const auto one = permutation_importance(forest, samples, Serial{}, 7, 3);
  const auto three = permutation_importance(forest, samples, Threads(3), 7, 3);
  CHECK(one.mean == three.mean);
  CHECK(one.deviation == three.deviation);
  CHECK(permutation_importance(forest, samples, Serial{}, 8, 3).mean != one.mean);
  CHECK(permutation_importance(forest, samples, Serial{}, 7, 1).deviation.isZero(0));
}

TEST_CASE("outputs count alike whatever their units, and samples by their weights") {
  auto samples = toy::sample(toy::ClippedLaws{}, 2000, 1);
  const auto before = permutation_importance(train_extra_trees(samples, {}, Threads{}, 1), samples, Serial{}, 1);
  samples.outputs.row(1) *= 1024;
  const auto scaled = permutation_importance(train_extra_trees(samples, {}, Threads{}, 1), samples, Serial{}, 1);
  CHECK(scaled.mean.isApprox(before.mean, 1e-4));
  // The first output hangs on inputs 0 and 1; where only samples with a clipped first output count, it varies no more.
  const auto forest = train_extra_trees(samples, {}, Threads{}, 1);
  samples.weights.resize(2000);
  for (Eigen::Index i = 0; i < 2000; ++i) samples.weights[i] = samples.outputs(0, i) >= 1 ? 1 : 1e-9;
  CHECK(permutation_importance(forest, samples, Serial{}, 1).mean[1] > 10 * before.mean[1]);
}

TEST_CASE("what cannot be is refused") {
  const auto samples = toy::sample(toy::Cliff{}, 50, 1);
  const auto forest = train_extra_trees(samples, {.trees = 2}, Serial{}, 1);
  CHECK_THROWS_WITH_AS(permutation_importance(forest, samples, Serial{}, 1, 0), doctest::Contains("repeats"),
                       ForestError);
  CHECK_THROWS_WITH_AS(permutation_importance(Forest<5, 1>(), samples, Serial{}, 1), doctest::Contains("empty"),
                       ForestError);
  Dataset<Eigen::Dynamic, 1> narrow;
  narrow.inputs = samples.inputs.topRows(4);
  narrow.outputs = samples.outputs;
  const Forest<Eigen::Dynamic, 1> wide(forest.raw());
  CHECK_THROWS_WITH_AS(permutation_importance(wide, narrow, Serial{}, 1),
                       doctest::Contains("4 inputs and 1 outputs, but the forest 5 and 1"), ForestError);
}

}  // namespace
}  // namespace surefoot
