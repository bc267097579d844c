#include "surefoot/motion/changes/possible_changes.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/one_sided_correction.hpp"

namespace {

bool has(const std::vector<surefoot::WalkChange>& changes, const std::string& name) {
  return std::ranges::find(changes, name, &surefoot::WalkChange::name) != changes.end();
}

}  // namespace

TEST_CASE("a small model changes in its coefficients, a large one in its sides and its timing too") {
  const auto small = surefoot::detail::possible_changes(surefoot::FullLinearCorrection(), 0.1, 0.3, true);
  CHECK(small.size() == 12);
  auto parameters = surefoot::OneSidedCorrection().parameters();
  parameters[12] = 0.4;  // dx per last dx
  const auto walk = surefoot::OneSidedCorrection::from_parameters(parameters);
  const auto large = surefoot::detail::possible_changes(walk, 0.1, 0.3, true);
  CHECK(large.size() == 21 + 6 + 1 + 1);
  CHECK(has(large, "dt per dt to the left"));
  CHECK(has(large, "dx per dx and last dx"));
  CHECK(!has(large, "dy per dy and last dy"));
  CHECK(has(large, "part of a cycle"));
  CHECK(!has(surefoot::detail::possible_changes(walk, 0.1, 0.3, false), "dt per dt to the left"));
}
