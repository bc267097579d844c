// A diagnosis of which nothing is known yet.
#include "surefoot/diagnose/diagnosis.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace surefoot {
namespace {

TEST_CASE("a diagnosis claims nothing before it is made, and what was not measured is no number") {
  const Diagnosis diagnosis;
  CHECK(diagnosis.verdict == Verdict::adequate);
  CHECK(diagnosis.effects.empty());
  CHECK(diagnosis.alternatives.empty());
  CHECK(std::isnan(diagnosis.noise_floor));
  CHECK(std::isnan(diagnosis.held_out_forest));
  CHECK(std::isnan(diagnosis.forest_residual.held_out_before));
  CHECK_FALSE(diagnosis.forest_residual.kept);
  CHECK(Evidence{}.p_value == 1);
}

}  // namespace
}  // namespace surefoot
