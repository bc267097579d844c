#include "surefoot/forest/wrap_around.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/extra_trees.hpp"

namespace surefoot {
namespace {

constexpr double pi = std::numbers::pi;

Dataset<2, 1> periodic_samples(Eigen::Index count, std::uint64_t seed, double noise) {
  Dataset<2, 1> samples;
  samples.inputs.resize(2, count);
  samples.outputs.resize(1, count);
  Rng rng(seed);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double angle = rng.uniform(-pi, pi);
    const double other = rng.uniform(-3, 3);
    samples.inputs.col(i) << static_cast<float>(angle), static_cast<float>(other);
    samples.outputs(0, i) = std::sin(angle + 1) + 0.5 * std::cos(other) + noise * rng.normal();
  }
  return samples;
}

struct Errors {
  double all = 0;   // mean squared errors
  double seam = 0;  // of the samples within a tenth of pi of the seam
};

template <class F>
Errors errors(const F& forest, const Dataset<2, 1>& test) {
  Errors errors;
  double near = 0;
  for (Eigen::Index i = 0; i < test.inputs.cols(); ++i) {
    const double off = forest.predict(test.inputs.col(i).cast<double>())[0] - test.outputs(0, i);
    errors.all += off * off / static_cast<double>(test.inputs.cols());
    if (std::abs(test.inputs(0, i)) < 0.9 * pi) continue;
    errors.seam += off * off;
    near += 1;
  }
  errors.seam /= near;
  return errors;
}

TEST_CASE("copies beyond the seam help there, at equal numbers of leaves") {
  const auto train = periodic_samples(3000, 1, 0.2);
  const auto wrapped = wrap_around(train, 0);
  const auto test = periodic_samples(8000, 2, 0);
  const ExtraTreesOptions options{.trees = 50, .max_leaves = 200};
  const auto forest = train_extra_trees(train, options, Threads{}, 1);
  const auto periodic = train_extra_trees(wrapped, options, Threads{}, 1);
  CHECK(periodic.leaves() == forest.leaves());
  const Errors open = errors(forest, test);
  const Errors closed = errors(periodic, test);
  CHECK(closed.seam < 0.8 * open.seam);
  CHECK(closed.all < 0.97 * open.all);
  const auto linear = errors(train_extra_trees<LinearLeaf>(train, {.min_leaf = 20}, Threads{}, 1), test);
  const auto periodic_linear = errors(train_extra_trees<LinearLeaf>(wrapped, {.min_leaf = 20}, Threads{}, 1), test);
  CHECK(periodic_linear.seam < 0.85 * linear.seam);
}

TEST_CASE("copies are those near the ends, moved by one period") {
  Dataset<2, 1> samples;
  samples.inputs.resize(2, 4);
  samples.inputs << 0, 1, 5, 9.5,  //
      1, 2, 3, 4;
  samples.outputs.resize(1, 4);
  samples.outputs << 10, 20, 30, 40;
  samples.weights.resize(4);
  samples.weights << 1, 2, 3, 4;
  const auto wrapped = wrap_around(samples, 0, {.low = 0, .period = 10, .margin = 0.08});
  REQUIRE(wrapped.inputs.cols() == 6);
  CHECK(wrapped.inputs.leftCols(4) == samples.inputs);
  CHECK(wrapped.inputs.col(4) == Eigen::Vector2f(10, 1));
  CHECK(wrapped.inputs.col(5) == Eigen::Vector2f(-0.5F, 4));
  CHECK(wrapped.outputs(0, 4) == 10);
  CHECK(wrapped.outputs(0, 5) == 40);
  CHECK(wrapped.weights[4] == 1);
  CHECK(wrapped.weights[5] == 4);
  CHECK_NOTHROW(check(wrapped));
}

TEST_CASE("two inputs that wrap around fill their corners") {
  Dataset<2, 1> samples;
  samples.inputs.resize(2, 1);
  samples.inputs << 3.1F, -3.1F;
  samples.outputs.setZero(1, 1);
  const auto wrapped = wrap_around(wrap_around(samples, 0), 1);
  REQUIRE(wrapped.inputs.cols() == 4);
  const auto turn = static_cast<float>(2 * pi);
  CHECK(wrapped.inputs.col(3).isApprox(Eigen::Vector2f(3.1F - turn, turn - 3.1F)));
}

TEST_CASE("wrong inputs and ranges are named") {
  auto samples = periodic_samples(10, 1, 0);
  CHECK_THROWS_WITH_AS(wrap_around(samples, 2), doctest::Contains("input must be"), ForestError);
  CHECK_THROWS_WITH_AS(wrap_around(samples, -1), doctest::Contains("input must be"), ForestError);
  CHECK_THROWS_WITH_AS(wrap_around(samples, 0, {.low = NAN}), doctest::Contains("low"), ForestError);
  CHECK_THROWS_WITH_AS(wrap_around(samples, 0, {.period = 0}), doctest::Contains("period"), ForestError);
  CHECK_THROWS_WITH_AS(wrap_around(samples, 0, {.margin = 0.6}), doctest::Contains("margin"), ForestError);
  samples.inputs(0, 3) = static_cast<float>(pi);  // rounded up, but the end of the range all the same
  CHECK_NOTHROW(wrap_around(samples, 0));
  samples.inputs(0, 3) = 3.2F;
  CHECK_THROWS_WITH_AS(wrap_around(samples, 0), doctest::Contains("sample 3 is outside"), ForestError);
}

}  // namespace
}  // namespace surefoot
