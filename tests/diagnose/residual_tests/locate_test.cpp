// Location of a mismatch: planted regions are found, and noise has none.
#include "surefoot/diagnose/residual_tests/locate.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

// Four recordings of 200 samples: a slow angle, a fast one, and time.
FeatureTable table_of(std::uint64_t seed) {
  FeatureTable table;
  table.names = {"slow", "fast", "time"};
  table.values.resize(3, 800);
  for (Eigen::Index j = 0; j < 800; ++j) {
    const Eigen::Index row = j % 200;
    const double t = 0.05 * static_cast<double>(row), phase = static_cast<double>(seed) + static_cast<double>(j / 200);
    table.values.col(j) << std::sin(0.8 * t + phase), std::sin(5.3 * t + 2 * phase), t;
    table.recording.push_back(static_cast<std::size_t>(j / 200));
    table.row.push_back(row);
  }
  return table;
}

Eigen::VectorXd noise_energy(std::uint64_t seed) {
  Rng rng(seed, 1U);
  Eigen::VectorXd energy(800);
  for (double& value : energy) value = std::pow(rng.normal(), 2);
  return energy;
}

TEST_CASE("a planted region is found, with its rule, its share and a small p-value") {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const FeatureTable table = table_of(seed);
    Eigen::VectorXd energy = noise_energy(seed);
    double planted = 0;
    for (Eigen::Index j = 0; j < 800; ++j) {
      if (table.values(1, j) > 0.6) planted += energy[j] *= 4;
    }
    const auto regions = find_region(table, energy, 2, 99, seed);
    REQUIRE(regions.size() == 1);
    CHECK(regions[0].rule.find("fast >= 0.") == 0);
    CHECK(regions[0].share_of_excess == doctest::Approx(planted / energy.sum()).epsilon(0.4));
    CHECK(regions[0].share_of_samples < 0.5);
    found += regions[0].p_value < 0.05 ? 1 : 0;
  }
  CHECK(found == 10);
}

TEST_CASE("a region of two conditions is told as one rule") {
  const FeatureTable table = table_of(1);
  Eigen::VectorXd energy = noise_energy(1);
  for (Eigen::Index j = 0; j < 800; ++j) {
    if (table.values(1, j) > 0 && table.values(0, j) < 0) energy[j] *= 8;
  }
  const auto regions = find_region(table, energy, 2, 99, 1);
  REQUIRE(regions.size() == 1);
  CHECK(regions[0].rule.find(" and ") != std::string::npos);
  CHECK(regions[0].rule.find("slow < ") != std::string::npos);
  CHECK(regions[0].rule.find("fast >= ") != std::string::npos);
  CHECK(regions[0].p_value < 0.05);
}

TEST_CASE("noise has a region with a small p-value about as seldom as chance allows") {
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const auto regions = find_region(table_of(seed), noise_energy(seed), 2, 99, seed);
    alarms += !regions.empty() && regions[0].p_value < 0.05 ? 1 : 0;
  }
  INFO(alarms << " of 60");
  CHECK(alarms <= 8);
}

TEST_CASE("too few samples, or no energy at all, have no region") {
  const FeatureTable table = table_of(1);
  CHECK(find_region(table, Eigen::VectorXd::Zero(800), 2, 20, 1).empty());
  FeatureTable few = table;
  few.values = table.values.leftCols(40).eval();
  few.recording.resize(40);
  CHECK(find_region(few, Eigen::VectorXd::Ones(40), 2, 20, 1).empty());
}

TEST_CASE("the stretches with most of a mismatch come first, with the time they span") {
  std::vector<Recording> recordings{toys::tank_recording(0, 401), toys::tank_recording(1, 401)};
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, recordings);
  std::vector<SimulatedRun> runs;
  for (const Recording& recording : bound.recordings)
    runs.push_back({recording.outputs, Eigen::MatrixXd::Zero(1, 401)});
  runs[1].outputs.middleCols(145, 12).array() += 0.5;  // 7.25 s to 7.8 s of 20 s
  const FeatureTable table = make_features(bound, {0, 1}, runs, 2, InputsOf::own_row);
  const Eigen::VectorXd energy = mismatch_energy(bound, {0, 1}, runs, Vec<1>(0.1), table, 0);
  CHECK(energy.sum() == doctest::Approx(6 * 25));
  const auto intervals = find_intervals(bound, {0, 1}, table, energy, 3);
  REQUIRE(intervals.size() == 3);
  CHECK(intervals[0].recording == "tank 1");
  CHECK(intervals[0].from == doctest::Approx(7));
  CHECK(intervals[0].to == doctest::Approx(8));
  CHECK(intervals[0].share_of_excess == doctest::Approx(1));
  CHECK(intervals[1].share_of_excess == 0);
}

TEST_CASE("energy of changes belongs to where the error arises, not to where it lasts") {
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, {toys::tank_recording(0, 101)});
  std::vector<SimulatedRun> runs{{bound.recordings[0].outputs, Eigen::MatrixXd::Zero(1, 101)}};
  runs[0].outputs.rightCols(50).array() += 0.2;  // from row 51 on
  const FeatureTable table = make_features(bound, {0}, runs, 1, InputsOf::own_row);
  const Eigen::VectorXd energy = mismatch_energy(bound, {0}, runs, Vec<1>(0.1), table, 5);
  for (Eigen::Index row = 0; row < 101; ++row) CHECK(energy[row] == doctest::Approx(row >= 51 && row < 56 ? 4 : 0));
  CHECK(mismatch_energy(bound, {0}, runs, Vec<1>(0.001), table, 0).maxCoeff() == 50);  // no sample decides alone
}

TEST_CASE("two limits of one feature are told as the tighter one") {
  const FeatureTable table = table_of(1);
  Eigen::VectorXd energy = noise_energy(1);
  for (Eigen::Index j = 0; j < 800; ++j) energy[j] *= std::exp(4 * table.values(1, j));
  const auto regions = find_region(table, energy, 4, 20, 1);
  REQUIRE(regions.size() == 1);
  const std::string& rule = regions[0].rule;
  CHECK(rule.find("fast >= ") != std::string::npos);
  CHECK(rule.find("fast >= ") == rule.rfind("fast >= "));
}

TEST_CASE("a region that is hardly denser than the rest is none") {
  const FeatureTable table = table_of(1);
  Eigen::VectorXd energy = Eigen::VectorXd::Ones(800);
  for (Eigen::Index j = 0; j < 800; ++j) energy[j] = table.values(1, j) > 0 ? 1.1 : 0.9;
  CHECK(find_region(table, energy, 2, 20, 1).empty());
}

}  // namespace
}  // namespace surefoot::diagnosis
