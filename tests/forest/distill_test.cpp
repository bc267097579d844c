#include "surefoot/forest/distill.hpp"

#include <doctest/doctest.h>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

TEST_CASE("one distilled tree is better than a forest of equal bytes") {
  const auto samples = toy::sample(toy::Cliff{}, 8000, 1);
  const auto test = toy::sample(toy::Cliff{}, 4000, 2);
  const auto teacher = train_extra_trees<LinearLeaf>(samples, {.min_leaf = 10}, Serial{}, 1);
  const auto small = distill(teacher, samples.inputs, {.max_leaves = 40, .draws = 8, .points = 8000}, Threads(2), 1);
  CHECK(small.forest.trees() == 1);
  CHECK(small.forest.leaves() <= 40);
  CHECK(small.forest.leaves() >= 30);
  const auto direct =
      train_extra_trees<LinearLeaf>(samples, {.trees = 5, .min_leaf = 10, .max_leaves = 8}, Serial{}, 1);
  CHECK(small.forest.bytes() <= direct.bytes());
  CHECK(fraction_of_variance_unexplained(small.forest, test) < 0.3 * fraction_of_variance_unexplained(direct, test));
  CHECK(small.loss == doctest::Approx(fraction_of_variance_unexplained(small.forest, test))
                          .epsilon(0.5));  // the teacher is nearly perfect
}

TEST_CASE("distillation is the same for any executor, and differs by seed") {
  const auto samples = toy::sample(toy::ClippedLaws{}, 1000, 1);
  const auto teacher = train_extra_trees(samples, {.trees = 5}, Serial{}, 1);
  const DistillOptions options{.trees = 2, .max_leaves = 8, .draws = 4, .points = 1000};
  const auto one = distill(teacher, samples.inputs, options, Serial{}, 1);
  CHECK(one.forest == distill(teacher, samples.inputs, options, Threads(3), 1).forest);
  CHECK(one.forest.trees() == 2);
  CHECK_FALSE(one.forest == distill(teacher, samples.inputs, options, Serial{}, 2).forest);
}

TEST_CASE("a single leaf is the fit to all answers; constant answers need no more") {
  const auto samples = toy::sample(toy::Cliff{}, 500, 1);
  const auto teacher = train_extra_trees(samples, {.trees = 3}, Serial{}, 1);
  const auto leaf = distill<ConstantLeaf>(teacher, samples.inputs, {.max_leaves = 1, .mixing = 0}, Serial{}, 1).forest;
  CHECK(leaf.leaves() == 1);
  CHECK(leaf.predict(Vec<5>::Zero())[0] == doctest::Approx(samples.outputs.mean()).epsilon(0.05));
  auto flat = samples;
  flat.outputs.setConstant(2.5);
  const auto constant = train_extra_trees(flat, {.trees = 3}, Serial{}, 1);
  const auto same = distill(constant, samples.inputs, {.points = 500}, Serial{}, 1);
  CHECK(same.forest.leaves() == 1);
  CHECK(same.loss == 0);
  CHECK(same.forest.predict(Vec<5>::Zero())[0] == 2.5);
}

TEST_CASE("points come from the samples, mixed or not") {
  Dataset<2, 1> samples{Eigen::Matrix<float, 2, 2>{{0, 1}, {0, 1}}, Eigen::Matrix<double, 1, 2>{0, 1}, {}};
  const auto teacher = train_extra_trees(samples, {.trees = 1, .min_leaf = 1}, Serial{}, 1);
  const auto mixed = [&](double mixing) {
    const auto asked = ask(teacher, samples.inputs, 1000, mixing, Rng(1));
    int count = 0;
    for (Eigen::Index i = 0; i < 1000; ++i) {
      const Vec<2> x = asked.inputs.col(i).cast<double>();
      CHECK(asked.outputs(0, i) == teacher.predict(x)[0]);
      if (x[0] != x[1]) ++count;
    }
    return count;
  };
  CHECK(mixed(0) == 0);
  CHECK(mixed(1) > 400);
  CHECK(mixed(1) < 600);
}

TEST_CASE("bad options of distillation are named") {
  const auto samples = toy::sample(toy::Cliff{}, 50, 1);
  const auto teacher = train_extra_trees(samples, {.trees = 1}, Serial{}, 1);
  const auto distilled = [&](const DistillOptions& options) { distill(teacher, samples.inputs, options, Serial{}, 1); };
  CHECK_THROWS_WITH_AS(distilled({.trees = 0}), doctest::Contains("trees"), ForestError);
  CHECK_THROWS_WITH_AS(distilled({.max_leaves = 0}), doctest::Contains("max_leaves"), ForestError);
  CHECK_THROWS_WITH_AS(distilled({.min_leaf = 0}), doctest::Contains("min_leaf"), ForestError);
  CHECK_THROWS_WITH_AS(distilled({.draws = 0}), doctest::Contains("draws"), ForestError);
  CHECK_THROWS_WITH_AS(distilled({.points = 0}), doctest::Contains("points"), ForestError);
  CHECK_THROWS_WITH_AS(distilled({.mixing = 1.5}), doctest::Contains("mixing"), ForestError);
  CHECK_THROWS_WITH_AS(distill(Forest<5, 1>(), samples.inputs, {}, Serial{}, 1), doctest::Contains("empty"),
                       ForestError);
  CHECK_THROWS_WITH_AS(distill(teacher, decltype(samples.inputs)(5, 0), {}, Serial{}, 1),
                       doctest::Contains("at least one sample"), ForestError);
}

}  // namespace
}  // namespace surefoot
