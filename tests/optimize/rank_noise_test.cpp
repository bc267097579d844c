#include "surefoot/optimize/rank_noise.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/core/rng.hpp"

namespace surefoot {
namespace {

TEST_CASE("equal orders have no disorder, whatever the values") {
  CHECK(rank_disorder(std::vector<double>{3, 1, 2}, std::vector<double>{300, -5, 0}) == 0);
  CHECK(rank_disorder(std::vector<double>{1, 1, 1}, std::vector<double>{2, 2, 2}) == 0);
}

TEST_CASE("disorder is the mean change of rank over that of a shuffle") {
  // Ranks 0 1 2 3 against 3 2 1 0: mean change 2, that of a shuffle (4^2 - 1) / (3 * 4) = 1.25.
  CHECK(rank_disorder(std::vector<double>{1, 2, 3, 4}, std::vector<double>{4, 3, 2, 1}) == doctest::Approx(2 / 1.25));
}

TEST_CASE("pure noise has a disorder of about 1") {
  Rng rng(1);
  double sum = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<double> a(12), b(12);
    for (double& x : a) x = rng.normal();
    for (double& x : b) x = rng.normal();
    sum += rank_disorder(a, b) / 200;
  }
  CHECK(std::abs(sum - 1) < 0.06);  // four standard errors
}

TEST_CASE("values that are not finite rank last") {
  const std::vector<double> numbers{1, 5, 3};
  CHECK(rank_disorder(numbers, std::vector<double>{1, std::nan(""), 3}) == 0);
  CHECK(rank_disorder(numbers, std::vector<double>{std::nan(""), 2, 3}) > 0);
}

}  // namespace
}  // namespace surefoot
