#include "surefoot/forest/shrink.hpp"

#include <doctest/doctest.h>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

const DistillOptions quick{.max_leaves = 100, .draws = 4, .points = 4000};

TEST_CASE("a forest shrinks to every budget in bytes, with the loss stated") {
  const auto forest =
      train_extra_trees<LinearLeaf>(toy::sample(toy::Cliff{}, 4000, 1), {.trees = 8, .min_leaf = 10}, Serial{}, 1);
  const auto samples = toy::sample(toy::Cliff{}, 4000, 2);
  const auto test = toy::sample(toy::Cliff{}, 4000, 3);
  double before = 0;
  for (const std::size_t bytes : {100'000U, 10'000U, 2'000U, 500U}) {
    const auto small = shrink_to(forest, samples, {.bytes = bytes}, 1, Threads(2), quick);
    CHECK(small.bytes == small.forest.bytes());
    CHECK(small.bytes <= bytes);
    CHECK(small.error_before == doctest::Approx(fraction_of_variance_unexplained(forest, test)).epsilon(0.3));
    CHECK(small.error_after == doctest::Approx(fraction_of_variance_unexplained(small.forest, test)).epsilon(0.3));
    CHECK(small.error_after >= before);
    CHECK_FALSE(small.how.empty());
    before = small.error_after;
  }
}

TEST_CASE("without a limit the forest stays as it is") {
  const auto samples = toy::sample(toy::Cliff{}, 2000, 1);
  const auto forest = train_extra_trees(samples, {.trees = 8, .min_leaf = 2}, Serial{}, 1);
  const auto same = shrink_to(forest, samples, {}, 1, Serial{}, quick);
  CHECK(same.forest == forest);
  CHECK(same.error_after == same.error_before);
}

TEST_CASE("leaves of another kind are distilled") {
  const auto samples = toy::sample(toy::ClippedLaws{}, 4000, 1);
  const auto forest = train_extra_trees(samples, {.trees = 10}, Serial{}, 1);
  const auto fresh = toy::sample(toy::ClippedLaws{}, 4000, 2);
  const auto linear = shrink_to<LinearLeaf>(forest, fresh, {.bytes = 3000}, 1, Serial{}, quick);
  const auto constant = shrink_to(forest, fresh, {.bytes = 3000}, 1, Serial{}, quick);
  CHECK(linear.how == "distilled to 1 tree");
  CHECK(linear.bytes <= 3000);
  CHECK(linear.error_after < constant.error_after);
}

TEST_CASE("a budget in time is met") {
  const auto samples = toy::sample(toy::Cliff{}, 4000, 1);
  const auto forest = train_extra_trees<LinearLeaf>(samples, {.trees = 100, .min_leaf = 10}, Serial{}, 1);
  const double before = nanoseconds_per_prediction(forest, samples.inputs);
  const auto fast = shrink_to(forest, samples, {.nanoseconds = before / 3}, 1, Serial{}, quick);
  CHECK(fast.nanoseconds > 0);
  CHECK(fast.nanoseconds <= before / 3);
  CHECK(fast.forest.trees() < 100);
}

TEST_CASE("a budget that nothing meets is refused") {
  const auto samples = toy::sample(toy::Cliff{}, 100, 1);
  const auto forest = train_extra_trees(samples, {.trees = 2}, Serial{}, 1);
  CHECK_THROWS_WITH_AS(shrink_to(forest, samples, {.bytes = 60}, 1, Serial{}, quick), doctest::Contains("60 bytes"),
                       ForestError);
  CHECK_THROWS_WITH_AS(shrink_to(forest, samples, {.nanoseconds = 1e-3}, 1, Serial{}, quick),
                       doctest::Contains("nothing fits"), ForestError);
  Dataset<5, 1> few{samples.inputs.leftCols(7), samples.outputs.leftCols(7), {}};
  CHECK_THROWS_WITH_AS(shrink_to(forest, few, {}), doctest::Contains("8 samples"), ForestError);
}

}  // namespace
}  // namespace surefoot
