// Residuals: which cells count, angles, weights, and typical sizes.
#include "surefoot/diagnose/estimation/residuals.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "surefoot/core/rng.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/servo_pendulum.hpp"

namespace surefoot::diagnosis {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

// A block that reads this in every row, and a simulation that says 0 throughout.
struct Comparison {
  BoundSimulator bound;
  SimulatedRun run;
};
Comparison zero_against(const Eigen::MatrixXd& measured) {
  Recording recording = toys::blank_recording(toys::SlidingBlock{}.info(), measured.cols(), 0.1);
  recording.outputs = measured;
  SimulatedRun run{Eigen::MatrixXd::Zero(2, measured.cols()), Eigen::MatrixXd::Zero(2, measured.cols())};
  return {bind_simulator(toys::SlidingBlock{}, {recording}), run};
}

TEST_CASE("cells are what was measured, without the first row where the start is known") {
  Recording recording = toys::blank_recording(toys::SlidingBlock{}.info(), 3, 0.1);
  recording.outputs(1, 1) = not_measured;
  const std::vector<Cell> known = cells_of(recording);
  REQUIRE(known.size() == 3);
  CHECK((known[0].row == 1 && known[0].output == 0));
  CHECK((known[1].row == 2 && known[1].output == 0));
  CHECK((known[2].row == 2 && known[2].output == 1));
  recording.initial_scale[0] = 0.1;
  CHECK(cells_of(recording).size() == 5);
}

TEST_CASE("residuals are simulated minus measured, in units of sigma of their output") {
  Eigen::MatrixXd measured(2, 3);
  measured << 0, 1, 2, 0, -10, not_measured;
  const auto [bound, run] = zero_against(measured);
  const std::vector<Cell> cells = cells_of(bound.recordings[0]);
  CHECK(raw_residuals(bound, 0, run, cells) == Vec<3>(-1, 10, -2));
  CHECK(weighted_residuals(bound, 0, run, cells, {.sigma = Vec<2>(0.5, 10), .whitening = {}}) == Vec<3>(-2, 1, -4));
}

TEST_CASE("a whitening matrix of the right size replaces sigma") {
  Eigen::MatrixXd measured(2, 2);
  measured << 0, 1, 0, 3;
  const auto [bound, run] = zero_against(measured);
  Weighting weighting{.sigma = Vec<2>(1, 1), .whitening = {Eigen::MatrixXd{{1.0, 1.0}, {0.0, 2.0}}}};
  const std::vector<Cell> cells = cells_of(bound.recordings[0]);
  CHECK(weighted_residuals(bound, 0, run, cells, weighting) == Vec<2>(-4, -6));
  weighting.whitening[0] = Eigen::MatrixXd::Identity(3, 3);  // of another set of cells
  CHECK(weighted_residuals(bound, 0, run, cells, weighting) == Vec<2>(-1, -3));
}

TEST_CASE("angles that are known up to full turns differ by the short way round, others by the long one") {
  Recording recording = toys::blank_recording(toys::ServoPendulum{}.info(), 2, 0.1);
  recording.outputs << 0, -3.1;
  const SimulatedRun run{Eigen::MatrixXd{{0.0, 3.1}}, Eigen::MatrixXd::Zero(2, 2)};
  const BoundSimulator within = bind_simulator(toys::ServoPendulum{}, {recording});
  CHECK(raw_residuals(within, 0, run, {{1, 0}})[0] == doctest::Approx(6.2 - 2 * std::numbers::pi));
  recording.outputs << 7, -3.1;  // more than a turn: this sensor counts them
  const BoundSimulator beyond = bind_simulator(toys::ServoPendulum{}, {recording});
  CHECK(raw_residuals(beyond, 0, run, {{1, 0}})[0] == doctest::Approx(6.2));
}

TEST_CASE("a simulation that ran away is infinitely off") {
  auto [bound, run] = zero_against(Eigen::MatrixXd::Zero(2, 3));
  run.finite = false;
  CHECK((raw_residuals(bound, 0, run, cells_of(bound.recordings[0])).array() == std::numeric_limits<double>::infinity())
            .all());
}

TEST_CASE("sizes of residuals are those of the noise, however wild a few of them are") {
  Eigen::MatrixXd measured(2, 2000);
  Rng rng(1);
  for (Eigen::Index i = 0; i < 2000; ++i) measured.col(i) << 0.3 * rng.normal(), 5 * rng.normal();
  for (Eigen::Index i = 100; i < 2000; i += 500) measured(0, i) = 1000;
  const auto [bound, run] = zero_against(measured);
  const Eigen::VectorXd sizes = residual_sizes(bound, {0}, {run});
  CHECK(sizes[0] == doctest::Approx(0.3).epsilon(0.05));
  CHECK(sizes[1] == doctest::Approx(5).epsilon(0.05));
  const auto [exact, same] = zero_against(Eigen::MatrixXd::Zero(2, 10));
  CHECK(residual_sizes(exact, {0}, {same})[0] > 0);  // may be divided by
}

}  // namespace
}  // namespace surefoot::diagnosis
