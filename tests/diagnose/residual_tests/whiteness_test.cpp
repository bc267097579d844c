// Detection: noise is not taken for something missing, and what is missing not for noise.
#include "surefoot/diagnose/residual_tests/whiteness.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

// Four recordings of 600 rows whose residuals are noise of deviation 0.01 m that is correlated by `memory` from row to
// row, and on top of it a sine of 0.5 Hz.
struct Remains {
  BoundSimulator bound;
  std::vector<SimulatedRun> runs;
  std::vector<std::size_t> all{0, 1, 2, 3};
};
Remains remains(double memory, double sine, std::uint64_t seed) {
  std::vector<Recording> recordings;
  std::vector<SimulatedRun> runs;
  for (int r = 0; r < 4; ++r) {
    Recording recording = toys::blank_recording(toys::LeakyTank{}.info(), 600, 0.02);
    Rng rng(seed, static_cast<std::uint64_t>(r));
    double noise = 0;
    for (Eigen::Index i = 0; i < 600; ++i) {
      noise = memory * noise + 0.01 * std::sqrt(1 - memory * memory) * rng.normal();
      recording.outputs(0, i) = noise + sine * std::sin(std::numbers::pi * recording.time[i] + r);
    }
    recordings.push_back(std::move(recording));
    runs.push_back({Eigen::MatrixXd::Zero(1, 600), Eigen::MatrixXd::Zero(1, 600)});
  }
  return {bind_simulator(toys::LeakyTank{}, std::move(recordings)), std::move(runs)};
}

WhitenessTest structure_of(const Remains& r) { return test_whiteness(r.bound, r.all, r.runs, 0, 8, 80); }

TEST_CASE("noise has no structure, even if it is correlated from row to row") {
  for (const double memory : {0.0, 0.6}) {
    int alarms = 0, unexplained = 0;
    double share = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const WhitenessTest one = structure_of(remains(memory, 0, seed));
      alarms += one.p_value < 0.01 ? 1 : 0;
      unexplained += one.p_value < 0.001 && one.share > 0.12 ? 1 : 0;
      share += one.share / 200;
    }
    INFO("memory " << memory << ": " << alarms << " alarms, share " << share);
    CHECK(alarms <=
          (memory > 0 ? 30 : 8));  // noise that is not forgotten for a long time looks like a little structure
    CHECK(unexplained == 0);       // but not like enough of it to call a model wrong
    CHECK(share < 0.03);
  }
}

TEST_CASE("the typical size of residuals is that of the median recording, not of one that is far off") {
  Remains r = remains(0, 0, 5);
  r.runs[2].outputs.array() += 1;
  const WhitenessTest one = structure_of(r);
  CHECK(one.rms == doctest::Approx(0.5).epsilon(0.01));
  CHECK(one.typical == doctest::Approx(0.01).epsilon(0.1));
}

TEST_CASE("a slow error has structure, and the share of it is told") {
  for (const double sine : {0.005, 0.01, 0.05}) {
    const double truth = 0.5 * sine * sine / (0.5 * sine * sine + 1e-4);
    int found = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const WhitenessTest one = structure_of(remains(0.3, sine, seed));
      found += one.p_value < 0.001 ? 1 : 0;
      CHECK(one.share == doctest::Approx(truth).epsilon(0.35));
      CHECK(one.rms == doctest::Approx(std::sqrt(0.5 * sine * sine + 1e-4)).epsilon(0.15));
    }
    INFO("sine " << sine << ": found " << found << " of 20");
    CHECK(found >= 19);
  }
}

TEST_CASE("an oscillation has structure, whatever its period") {
  for (const double rows_per_turn : {14.0, 36.0, 50.0}) {  // some are at right angles to themselves 6 to 12 rows later
    Remains r = remains(0.3, 0, 7);
    for (std::size_t k = 0; k < 4; ++k) {
      for (Eigen::Index i = 0; i < 600; ++i) {
        r.bound.recordings[k].outputs(0, i) +=
            0.01 * std::sin(2 * std::numbers::pi * static_cast<double>(i) / rows_per_turn);
      }
    }
    INFO(rows_per_turn << " rows");
    CHECK(structure_of(r).p_value < 1e-4);
    CHECK(structure_of(r).share == doctest::Approx(1.0 / 3).epsilon(0.3));
  }
}

TEST_CASE("single outliers and gaps are no structure") {
  Remains r = remains(0, 0, 1);
  for (Recording& recording : r.bound.recordings) {
    for (Eigen::Index i = 50; i < 600; i += 100) recording.outputs(0, i) = 5;
    for (Eigen::Index i = 300; i < 330; ++i) recording.outputs(0, i) = std::numeric_limits<double>::quiet_NaN();
  }
  CHECK(structure_of(r).p_value > 0.01);
}

TEST_CASE("what residuals from before predict is no noise: vibrations, and slow errors among noise") {
  const auto predicted = [](double memory, double sine) {
    const Remains r = remains(memory, sine, 3);
    std::vector<Eigen::VectorXd> series;
    for (const std::size_t i : r.all) series.push_back(series_of(r.bound, i, r.runs[i], 0));
    return predicted_share(series, 8);
  };
  CHECK(predicted(0, 0) < 0.03);
  CHECK(predicted(0.6, 0) < 0.05);
  CHECK(predicted(0.9, 0) < 0.25);  // 0.9^16, and little by chance
  CHECK(predicted(0, 0.0141) == doctest::Approx(0.5).epsilon(0.1));
  CHECK(predicted(0, 0.0424) == doctest::Approx(0.9).epsilon(0.05));
  Rng rng(4);
  Eigen::VectorXd ringing(2000);  // a mode that noise keeps going: no single lag says much of it
  double now = 0, before = 0;
  for (double& value : ringing) {
    const double next = 1.9 * now - 0.98 * before + rng.normal();
    before = now;
    value = now = next;
  }
  CHECK(predicted_share({ringing}, 8) > 0.7);
  CHECK(predicted_share({Eigen::VectorXd::Zero(100)}, 8) == 0);
}

TEST_CASE("recordings too short to tell are not judged") {
  Remains r = remains(0, 0.05, 1);
  for (std::size_t i = 0; i < 4; ++i) {
    const Recording whole = r.bound.recordings[i];
    r.bound.recordings[i] = part_of(whole, 0, 40, whole.initial, whole.initial_scale);
    r.runs[i].outputs = r.runs[i].outputs.leftCols(40).eval();
  }
  CHECK(structure_of(r).p_value == 1);
  CHECK(structure_of(r).rms > 0);
}

}  // namespace
}  // namespace surefoot::diagnosis
