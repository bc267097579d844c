#include "surefoot/solve/quadratic_trend.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "tests/solve/sampled_values.hpp"

namespace surefoot {
namespace {

using toy::quadratic;

Dataset<3, 1> quadratic_samples(int count) { return toy::sampled_values(quadratic, count); }

QuadraticTrend fitted(const Dataset<3, 1>& data) { return QuadraticTrend::fit(detail::view_of(data)); }

TEST_CASE("a quadratic function is found from a few samples per term, whatever their number modulo four") {
  const Eigen::Vector3f x(0.3F, -0.4F, 0.8F);
  for (const int count : {40, 41, 42, 43}) {
    CHECK(fitted(quadratic_samples(count))(x.data()) == doctest::Approx(quadratic(x.cast<double>())).epsilon(1e-4));
  }
  CHECK(fitted(quadratic_samples(39)).empty());
}

TEST_CASE("more samples than needed are thinned out over all of them") {
  const Eigen::Vector3f x(0.3F, -0.4F, 0.8F);
  const auto trend = fitted(quadratic_samples(2 * static_cast<int>(QuadraticTrend::most_samples)));
  CHECK(trend(x.data()) == doctest::Approx(quadratic(x.cast<double>())).epsilon(1e-4));
}

TEST_CASE("an input that never changes does no harm") {
  Dataset<3, 1> flat = quadratic_samples(100);
  flat.inputs.row(2).setConstant(2);
  const auto trend = fitted(flat);
  REQUIRE_FALSE(trend.empty());
  CHECK(std::isfinite(trend(flat.inputs.col(0).data())));
}

TEST_CASE("far away a trend stays within the values it was fitted to") {
  const auto data = quadratic_samples(200);
  const Eigen::Vector3f far(100, 0, 0);
  CHECK(fitted(data)(far.data()) == data.outputs.minCoeff());
}

TEST_CASE("a trend comes back from its parameters") {
  const auto trend = fitted(quadratic_samples(100));
  CHECK(trend.parameters().size() == QuadraticTrend::count_of_parameters(3));
  CHECK(QuadraticTrend({trend.parameters().begin(), trend.parameters().end()}, 3) == trend);
}

TEST_CASE("so many inputs that a fit would cost more than it helps get no trend") {
  Dataset<Eigen::Dynamic, 1> wide;
  wide.inputs.setRandom(QuadraticTrend::most_inputs + 1, 10'000);
  wide.outputs.setRandom(1, 10'000);
  CHECK(QuadraticTrend::fit(detail::view_of(wide)).empty());
}

}  // namespace
}  // namespace surefoot
