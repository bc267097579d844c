#include "surefoot/solve/value_forest.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "tests/solve/sampled_values.hpp"

namespace surefoot {
namespace {

using toy::quadratic;
using toy::sampled_values;

const ExtraTreesOptions options{.trees = 6, .min_leaf = 20, .model_score = false};

double edge(const Vec<3>& x) { return x[0] + x[1] > 0 ? -10 : 0; }

double at(const ValueForest<3>& value, const Vec<3>& x) {
  const Eigen::Vector3f input = x.cast<float>();
  double out = 0;
  value.predict(input.data(), 1, &out);
  return out;
}

TEST_CASE("a quadratic value is learnt nearly exactly from few samples") {
  const auto value = train_value_forest(sampled_values(quadratic, 500), options, Serial{}, 1);
  REQUIRE_FALSE(value.trend.empty());
  const Vec<3> x(0.3, -0.4, 0.8);
  CHECK(at(value, x) == doctest::Approx(quadratic(x)).epsilon(1e-3));
}

TEST_CASE("values with an edge get no trend") {
  CHECK(train_value_forest(sampled_values(edge, 500), options, Serial{}, 1).trend.empty());
}

TEST_CASE("the mean of what the trees say is the value, alone and in a batch") {
  const auto value = train_value_forest(sampled_values(quadratic, 500), options, Serial{}, 1);
  const auto inputs = sampled_values(quadratic, 100).inputs;
  std::vector<double> batch(100), trees(value.trees());
  value.predict(inputs.data(), 100, batch.data());
  for (Eigen::Index i = 0; i < 100; ++i) {
    const Vec<3> x = inputs.col(i).cast<double>();
    CHECK(at(value, x) == batch[static_cast<std::size_t>(i)]);
    value.predict_trees(inputs.col(i).data(), trees.data());
    double mean = 0;
    for (const double one : trees) mean += one / static_cast<double>(trees.size());
    CHECK(mean == doctest::Approx(batch[static_cast<std::size_t>(i)]));
  }
}

}  // namespace
}  // namespace surefoot
