// Where differences smaller than the noise decide what comes later.
#include "surefoot/diagnose/estimation/sensitive_starts.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "falling_pendulum.hpp"
#include "surefoot/diagnose/diagnose.hpp"

namespace surefoot::diagnosis {
namespace {

std::vector<std::size_t> rows_of_first(bool near_top) {
  const BoundSimulator bound = bind_simulator(toys::FallingPendulum{}, toys::falling_log(near_top, 9, 0.3));
  const Hypothesis nominal = nominal_hypothesis(bound);
  Integration close = bound.integration;
  close.follow = 0.5;
  return sensitive_rows(bound, nominal, 0, simulate(bound, nominal, 0, close).states);
}

TEST_CASE("a pendulum that falls from its upper rest is cut once it falls, one that hangs is not") {
  CHECK(rows_of_first(false).empty());
  const std::vector<std::size_t> rows = rows_of_first(true);
  REQUIRE_FALSE(rows.empty());
  CHECK(rows.front() >= 25);   // of 400: the first border
  CHECK(rows.front() <= 100);  // it has fallen after two seconds
  std::size_t before = 0;
  for (const std::size_t row : rows) {
    CHECK(row - before >= 20);
    before = row;
  }
  CHECK(400 - before >= 20);
}

TEST_CASE("nothing is missing from a pendulum that falls to either side") {
  const Diagnosis found = diagnose(toys::FallingPendulum{}, toys::falling_log(true, 10, 0.25), {}, Serial{}, 1);
  INFO(found.sentence);
  CHECK(found.verdict == Verdict::parameters_only);
  CHECK(found.log_faults.empty());  // a whole recording that goes the other way is as one in another unit
  CHECK(found.noise_ratio < 1.3);
  CHECK(found.parameters[0].fit.value == doctest::Approx(10).epsilon(0.02));
  bool remarked = false;
  for (const Remark& remark : found.remarks) {
    remarked = remarked || (remark.recording.starts_with("fall_") && remark.text.find("parts") != std::string::npos);
  }
  CHECK(remarked);
}

}  // namespace
}  // namespace surefoot::diagnosis
