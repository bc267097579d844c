// Preparation of recordings.
#include "surefoot/diagnose/verdict/prepare.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("cuts compare every reading once, and parts start a quarter earlier from what was measured there") {
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, toys::noisy_tanks({}, 0.01, 1));
  const Recording& whole = bound.recordings[0];
  const Hypothesis nominal = nominal_hypothesis(bound);
  const auto runs = simulate_all(bound, nominal, {0}, {}, serially());
  const std::vector<Recording> parts = cut_recordings(bound, nominal, runs, 5);
  REQUIRE(parts.size() == 5);
  Eigen::Index next = 0;  // row that no part has compared yet
  for (const Recording& part : parts) {
    const Eigen::Index lead_in = next == 0 ? 0 : 6;  // of 24 rows
    REQUIRE(part.rows() == 24 + lead_in);
    CHECK(part.time[0] == whole.time[next - lead_in]);
    if (next > 0) CHECK(part.initial[0] == whole.outputs(0, next - lead_in));
    CHECK((part.initial_scale[0] > 0) == (next > 0));  // the first start is known
    for (Eigen::Index row = 0; row < lead_in; ++row) CHECK(std::isnan(part.outputs(0, row)));
    for (Eigen::Index row = lead_in; row < part.rows(); ++row) CHECK(part.outputs(0, row) == whole.outputs(0, next++));
  }
  CHECK(next == 120);
  CHECK(cut_recordings(bound, nominal, runs, 7).empty());  // of 17 rows each: too short
}

TEST_CASE("a recording that is cut at rows loses none, and each part starts from what was measured there") {
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, toys::noisy_tanks({}, 0.01, 1));
  const Recording& whole = bound.recordings[0];
  const SimulatedRun run = simulate(bound, nominal_hypothesis(bound), 0, {});
  const std::vector<Recording> parts = cut_at_rows(bound, 0, run.states, {50, 70});
  REQUIRE(parts.size() == 3);
  Eigen::Index next = 0;
  for (const Recording& part : parts) {
    CHECK(part.time[0] == whole.time[next]);
    CHECK((part.initial_scale[0] > 0) == (next > 0));  // the first start is known
    if (next > 0) CHECK(part.initial[0] == whole.outputs(0, next));
    for (Eigen::Index row = 0; row < part.rows(); ++row) CHECK(part.outputs(0, row) == whole.outputs(0, next++));
  }
  CHECK(next == whole.rows());
}

TEST_CASE("recordings stand in the order of their names, those of one name in that of what they hold") {
  const std::vector<Recording> all = toys::noisy_tanks({}, 0.01, 4);
  std::vector<Recording> shuffled{all[2], all[0], all[3], all[1]};
  sort_recordings(shuffled);
  for (std::size_t r = 0; r < all.size(); ++r) CHECK(shuffled[r].name == all[r].name);
  for (Recording& one : shuffled) one.name.clear();
  std::vector<Recording> reversed(shuffled.rbegin(), shuffled.rend());
  sort_recordings(shuffled);
  sort_recordings(reversed);
  for (std::size_t r = 0; r < all.size(); ++r) CHECK(shuffled[r].inputs == reversed[r].inputs);
}

}  // namespace
}  // namespace surefoot::diagnosis
