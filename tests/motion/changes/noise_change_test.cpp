#include "surefoot/motion/changes/noise_change.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/core/error.hpp"

TEST_CASE("Fisher's exact test of the lady who tastes tea") {
  // 3 of 4 against 1 of 4: p = 34 / 70, two-sided
  CHECK(surefoot::fall_change({.fell = 3, .sequences = 4}, {.fell = 1, .sequences = 4}).p_value ==
        doctest::Approx(34.0 / 70));
  CHECK(surefoot::fall_change({.fell = 0, .sequences = 25}, {.fell = 8, .sequences = 20}).log_bayes_factor > 3);
  CHECK(surefoot::fall_change({.fell = 0, .sequences = 25}, {.fell = 0, .sequences = 20}).log_bayes_factor < 0);
  CHECK_THROWS_AS(surefoot::fall_change({.fell = 2, .sequences = 1}, {.fell = 0, .sequences = 1}),
                  surefoot::MotionError);
}

TEST_CASE("a variance four times as large is a change if both are known well, and none if they are not") {
  const auto known = surefoot::variance_change({1, 300}, {4, 300}, 1);
  CHECK(known.ratio == doctest::Approx(4));
  CHECK(known.low > 3);
  CHECK(known.high < 5.2);
  CHECK(known.log_bayes_factor > 20);
  CHECK(known.log_likelihood_ratio > known.log_bayes_factor);
  CHECK(surefoot::variance_change({1, 3}, {4, 3}, 1).log_bayes_factor < 1);
  CHECK(surefoot::variance_change({1, 300}, {1, 300}, 1).log_bayes_factor < -1);
}

TEST_CASE("sequences that differ more than chance have fewer degrees of freedom") {
  const Eigen::VectorXd alike = Eigen::VectorXd::Constant(10, 2.0);
  CHECK(surefoot::pooled_variance(alike, 25).freedoms == doctest::Approx(250));
  Eigen::VectorXd unlike = alike;
  unlike[0] = 12;
  CHECK(surefoot::pooled_variance(unlike, 25).freedoms < 50);
}
