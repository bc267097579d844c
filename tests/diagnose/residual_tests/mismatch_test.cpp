// The share of a mismatch that is not noise.
#include "surefoot/diagnose/residual_tests/mismatch.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

// Noise of 0.01 m, and on top of it a slow sine.
Mismatch mismatch_with(double sine, const PredictionNoise& predictions = {}) {
  std::vector<Recording> recordings;
  std::vector<SimulatedRun> runs;
  for (std::uint64_t r = 0; r < 3; ++r) {
    Recording recording = toys::blank_recording(toys::LeakyTank{}.info(), 600, 0.02);
    Rng rng(5, r);
    for (Eigen::Index i = 0; i < 600; ++i) {
      recording.outputs(0, i) = 0.01 * rng.normal() + sine * std::sin(3 * recording.time[i]);
    }
    recordings.push_back(recording);
    runs.push_back({Eigen::MatrixXd::Zero(1, 600), Eigen::MatrixXd::Zero(1, 600)});
  }
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, recordings);
  return measure_mismatch(bound, {0, 1, 2}, runs, Eigen::VectorXd::Constant(1, 0.01), NoiseKind::measurement,
                          predictions);
}

TEST_CASE("noise alone is no mismatch") {
  const Mismatch mismatch = mismatch_with(0);
  CHECK(mismatch.p_value > 0.01);
  CHECK(mismatch.share == 0);
  CHECK(mismatch.energy < 0.2);
}

TEST_CASE("the energy of a mismatch is what it adds to the noise") {
  const Mismatch mismatch = mismatch_with(0.02);  // mean square 2e-4, beside 1e-4 of the noise
  CHECK(mismatch.p_value < 1e-6);
  CHECK(mismatch.share == doctest::Approx(2.0 / 3).epsilon(0.15));
  CHECK(mismatch.energy == doctest::Approx(2).epsilon(0.25));
}

TEST_CASE("what noise alone leaves of predictions is no mismatch") {
  CHECK(mismatch_with(0.02, {{1}, {2e-4}}).share < 0.1);
  CHECK(mismatch_with(0.02, {{1}, {1e-4}}).share == doctest::Approx(1.0 / 3).epsilon(0.3));
}

}  // namespace
}  // namespace surefoot::diagnosis
