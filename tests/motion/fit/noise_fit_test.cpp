#include "surefoot/motion/fit/noise_fit.hpp"

#include <doctest/doctest.h>

#include <cmath>

using surefoot::NoiseShape;
using surefoot::Vec;

TEST_CASE("the density of noise seen through blur is one, from hardly any noise to hardly any blur") {
  constexpr int count = 40'000;
  for (const NoiseShape shape : {NoiseShape::uniform, NoiseShape::gaussian}) {
    for (const double sigma : {1e-6, 1e-4, 0.003, 0.01, 0.2}) {
      CAPTURE(sigma);
      constexpr double blur = 0.01;
      const double end = 3 * sigma + 8 * blur, width = end / count;
      surefoot::detail::ComponentDeviations all{Eigen::ArrayXd::LinSpaced(count, width / 2, end - width / 2),
                                                Eigen::ArrayXd::Zero(count), Eigen::ArrayXd::Zero(count), blur};
      if (shape == NoiseShape::gaussian) all.size *= 3;  // of longer tails
      const double part = shape == NoiseShape::gaussian ? 3 * width : width;
      const Eigen::ArrayXd density = all.log_density(shape, Vec<3>(sigma, 0, 0)).exp();
      CHECK(2 * part * density.sum() == doctest::Approx(1).epsilon(1e-4));
      for (Eigen::Index i = 1; i < count; ++i) REQUIRE(density[i] <= density[i - 1] * (1 + 1e-9));
    }
  }
}
