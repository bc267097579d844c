#include "surefoot/forest/dataset.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

Dataset<5, 1> ten_samples() { return toy::sample(toy::Cliff{}, 10, 1); }

TEST_CASE("a complete data set passes, with and without weights") {
  Dataset<5, 1> samples = ten_samples();
  CHECK_NOTHROW(check(samples));
  samples.weights = Eigen::VectorXd::Constant(10, 0.5);
  CHECK_NOTHROW(check(samples));
}

TEST_CASE("an empty data set is refused") {
  CHECK_THROWS_AS(check(Dataset<5, 1>{}), ForestError);
  CHECK_THROWS_AS(check(Dataset<Eigen::Dynamic, Eigen::Dynamic>{}), ForestError);
  Dataset<Eigen::Dynamic, Eigen::Dynamic> nothing_to_learn;
  nothing_to_learn.inputs.resize(2, 10);
  nothing_to_learn.outputs.resize(0, 10);
  CHECK_THROWS_WITH_AS(check(nothing_to_learn), doctest::Contains("one output row"), ForestError);
}

TEST_CASE("sizes that disagree are named") {
  Dataset<5, 1> samples = ten_samples();
  samples.outputs.conservativeResize(1, 9);
  CHECK_THROWS_WITH_AS(check(samples), doctest::Contains("outputs has 9"), ForestError);
  samples = ten_samples();
  samples.weights = Eigen::VectorXd::Ones(11);
  CHECK_THROWS_WITH_AS(check(samples), doctest::Contains("got 11"), ForestError);
}

TEST_CASE("a number that is not finite is named by field and sample") {
  Dataset<5, 1> samples = ten_samples();
  samples.inputs(3, 7) = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH_AS(check(samples), doctest::Contains("input 3 of sample 7"), ForestError);
  samples = ten_samples();
  samples.outputs(0, 2) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH_AS(check(samples), doctest::Contains("output 0 of sample 2"), ForestError);
}

TEST_CASE("weights must be positive") {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    Dataset<5, 1> samples = ten_samples();
    samples.weights = Eigen::VectorXd::Ones(10);
    samples.weights[4] = bad;
    CHECK_THROWS_WITH_AS(check(samples), doctest::Contains("weight of sample 4"), ForestError);
  }
}

}  // namespace
}  // namespace surefoot
