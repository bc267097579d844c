#include "surefoot/solve/value_forest.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "surefoot/core/executor.hpp"

namespace surefoot {
namespace {

const ExtraTreesOptions options{.trees = 6, .min_leaf = 20, .model_score = false};

Dataset<3, 1> sampled(const std::function<double(const Vec<3>&)>& value, int count) {
  Rng rng(1);
  Dataset<3, 1> data;
  data.inputs.resize(3, count);
  data.outputs.resize(1, count);
  for (int i = 0; i < count; ++i) {
    const Vec<3> x(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
    data.inputs.col(i) = x.cast<float>();
    data.outputs(0, i) = value(x);
  }
  return data;
}

double quadratic(const Vec<3>& x) { return 1 + x[0] - 3 * x[1] * x[2] - 5 * x.squaredNorm(); }
double edge(const Vec<3>& x) { return x[0] + x[1] > 0 ? -10 : 0; }

double at(const ValueForest<3>& value, const Vec<3>& x) {
  const Eigen::Vector3f input = x.cast<float>();
  double out = 0;
  value.predict(input.data(), 1, &out);
  return out;
}

TEST_CASE("a quadratic value is learnt nearly exactly from few samples") {
  const auto value = train_value_forest(sampled(quadratic, 500), options, Serial{}, 1);
  REQUIRE_FALSE(value.trend.empty());
  const Vec<3> x(0.3, -0.4, 0.8);
  CHECK(at(value, x) == doctest::Approx(quadratic(x)).epsilon(1e-3));
}

TEST_CASE("values with an edge get no trend") {
  CHECK(train_value_forest(sampled(edge, 500), options, Serial{}, 1).trend.empty());
}

TEST_CASE("the mean of what the trees say is the value, alone and in a batch") {
  const auto value = train_value_forest(sampled(quadratic, 500), options, Serial{}, 1);
  const auto inputs = sampled(quadratic, 100).inputs;
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
