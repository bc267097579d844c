#include "surefoot/forest/fraction_of_variance_unexplained.hpp"

#include <doctest/doctest.h>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"

namespace surefoot {
namespace {

// Eight samples of one input; the first output is a step, the second the same for all.
Dataset<1, 2> steps() {
  Dataset<1, 2> samples;
  samples.inputs.resize(1, 8);
  samples.outputs.resize(2, 8);
  for (int i = 0; i < 8; ++i) {
    samples.inputs(0, i) = static_cast<float>(i);
    samples.outputs.col(i) << (i < 4 ? -1.0 : 1.0), 3.0;
  }
  return samples;
}

Forest<1, 2> forest_of(const Dataset<1, 2>& samples, int min_leaf) {
  const ExtraTreesOptions options{.trees = 1, .min_leaf = min_leaf, .threshold_rule = ThresholdRule::balanced};
  return train_extra_trees(samples, options, Serial{}, 1);
}

TEST_CASE(
    "nothing is unexplained by a perfect forest, everything by the mean; an output that is constant is left out") {
  const auto samples = steps();
  CHECK(fraction_of_variance_unexplained(forest_of(samples, 4), samples) == 0);
  CHECK(fraction_of_variance_unexplained(forest_of(samples, 8), samples) == doctest::Approx(1));
}

TEST_CASE("errors of weightier samples count more") {
  auto samples = steps();
  const auto forest = forest_of(samples, 4);
  samples.outputs(0, 0) = 0;
  samples.weights = Eigen::VectorXd::Ones(8);
  const double even = fraction_of_variance_unexplained(forest, samples);
  samples.weights[0] = 4;
  CHECK(fraction_of_variance_unexplained(forest, samples) > 1.5 * even);
}

TEST_CASE("a forest that is empty, or of other inputs than the samples, is named") {
  const auto samples = steps();
  CHECK_THROWS_WITH_AS(fraction_of_variance_unexplained(Forest<1, 2>(), samples), doctest::Contains("is empty"),
                       ForestError);
  Dataset<Eigen::Dynamic, Eigen::Dynamic> dynamic{samples.inputs, samples.outputs, {}};
  const auto forest = train_extra_trees(dynamic, {.trees = 1}, Serial{}, 1);
  dynamic.inputs.conservativeResize(2, 8);
  dynamic.inputs.row(1).setZero();
  CHECK_THROWS_WITH_AS(fraction_of_variance_unexplained(forest, dynamic),
                       doctest::Contains("the samples have 2 inputs and 2 outputs, but the forest 1 and 2"),
                       ForestError);
}

}  // namespace
}  // namespace surefoot
