// Features of the motion that a mismatch may depend on.
#include "surefoot/diagnose/residual_tests/features.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::SlidingBlock;

// Two blocks of 10 rows, 0.1 s apart, that turn round at row 4 and are pushed from row 6 on.
struct Motion {
  BoundSimulator bound;
  std::vector<SimulatedRun> runs;
};
Motion motion() {
  std::vector<Recording> recordings;
  std::vector<SimulatedRun> runs;
  for (int r = 0; r < 2; ++r) {
    Recording recording = toys::blank_recording(SlidingBlock{}.info(), 10, 0.1);
    recording.time.array() += 3;
    recording.inputs.rightCols(4).setConstant(1);
    recording.constants = {{"gravity", 9.81}, {"load", 0.5 * r}};
    recordings.push_back(recording);
    SimulatedRun run{Eigen::MatrixXd::Zero(2, 10), Eigen::MatrixXd::Zero(2, 10)};
    for (Eigen::Index row = 0; row < 10; ++row) run.states.col(row) << static_cast<double>(row), row < 4 ? 2 : -3;
    runs.push_back(run);
  }
  return {bind_simulator(SlidingBlock{}, recordings), runs};
}

double value(const FeatureTable& table, const std::string& name, Eigen::Index sample) {
  const auto found = std::find(table.names.begin(), table.names.end(), name);
  REQUIRE(found != table.names.end());
  return table.values(found - table.names.begin(), sample);
}

TEST_CASE("features are states, speeds without sign, reversals, inputs, time and constants that differ") {
  CHECK(
      feature_names(motion().bound, InputsOf::own_row) ==
      std::vector<std::string>{"x", "v", "abs(v)", "since_reversal(v)", "push", "since_change(push)", "time", "load"});
}

TEST_CASE("times since a reversal or a change count from the row in which it happened") {
  const auto [bound, runs] = motion();
  const FeatureTable table = make_features(bound, {0, 1}, runs, 1, InputsOf::own_row);
  REQUIRE(table.values.cols() == 20);
  CHECK(value(table, "since_reversal(v)", 3) == doctest::Approx(0.3));
  CHECK(value(table, "since_reversal(v)", 4) == 0);
  CHECK(value(table, "since_reversal(v)", 9) == doctest::Approx(0.5));
  CHECK(value(table, "since_change(push)", 6) == 0);
  CHECK(value(table, "since_change(push)", 8) == doctest::Approx(0.2));
  CHECK(value(table, "time", 0) == 0);
  CHECK(value(table, "abs(v)", 5) == 3);
}

TEST_CASE("of inputs that acted until a row, those of the row before are features, and called so") {
  const auto [bound, runs] = motion();
  const FeatureTable table = make_features(bound, {0}, runs, 1, InputsOf::row_before);
  CHECK(value(table, "last(push)", 0) == 0);
  CHECK(value(table, "last(push)", 6) == 0);  // pushed from there on
  CHECK(value(table, "last(push)", 7) == 1);
  CHECK(value(table, "since_change(last(push))", 6) == doctest::Approx(0.6));
  CHECK(value(table, "since_change(last(push))", 7) == doctest::Approx(0.1));
  CHECK(value(table, "abs(v)", 5) == 3);
  BoundSimulator other = bound;
  other.info.inputs[0].hold = InputHold::before;  // of its own row it acted until then
  CHECK(value(make_features(other, {0}, runs, 1, InputsOf::row_before), "push", 6) == 1);
  other = bound;
  other.structure.shown_at_once[0] = true;
  CHECK(value(make_features(other, {0}, runs, 1, InputsOf::row_before), "push", 6) == 1);
}

TEST_CASE("a stride leaves rows out but sees what happens in them") {
  const auto [bound, runs] = motion();
  const FeatureTable table = make_features(bound, {1}, {runs[1]}, 3, InputsOf::own_row);
  CHECK(table.row == std::vector<Eigen::Index>{0, 3, 6, 9});
  CHECK(table.recording == std::vector<std::size_t>(4, 0));
  CHECK(value(table, "since_reversal(v)", 2) == doctest::Approx(0.2));
  CHECK(value(table, "load", 2) == 0.5);
}

}  // namespace
}  // namespace surefoot::diagnosis
