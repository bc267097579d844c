#include "surefoot/motion/outliers.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/motion/linear_correction.hpp"
#include "tests/support/walks.hpp"

TEST_CASE("a wrong reading of a position or of a heading is an outlier, and nothing else") {
  auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 25, 1));
  CHECK(surefoot::find_outliers(surefoot::FullLinearCorrection(), walks, {}).empty());
  walks[3].poses(0, 24) += 5;
  const auto outliers = surefoot::find_outliers(surefoot::FullLinearCorrection(), walks, {});
  REQUIRE(outliers.size() == 1);
  CHECK(outliers[0].sequence == 3);
  CHECK(outliers[0].distance == doctest::Approx(5).epsilon(0.2));
  CHECK(outliers[0].typical < 1);
}
