// What noise leaves of simulations that follow the readings.
#include "surefoot/diagnose/residual_tests/prediction_noise.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

/// A place that nothing moves, and its speed; only the place is read.
struct Still {
  using State = Vec<2>;
  using Input = Vec<0>;
  using Output = Vec<1>;

  double noise = 0;  // as stated

  SimulatorInfo info() const {
    return {.name = "still",
            .states = {{"place", "m"}, {"speed", "m/s"}},
            .inputs = {},
            .outputs = {{.name = "place_m", .unit = "m", .noise = noise}},
            .parameters = {{"damping", "1/s", 0, 0, 1}}};
  }
  State derivative(const State& x, const Input& /*u*/, const Eigen::VectorXd& p) const { return {x[1], -p[0] * x[1]}; }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
};

constexpr double noise = 0.02;  // [m]
const std::vector<std::size_t> all{0, 1, 2};

/// Readings of it with noise that keeps `memory` from row to row, and a simulation that follows them by `follow`.
BoundSimulator read_with_noise(double memory, double follow, double stated) {
  std::vector<Recording> recordings;
  for (std::uint64_t r = 0; r < all.size(); ++r) {
    Recording one = toys::blank_recording(Still{}.info(), 2000, 0.01);
    Rng rng(11, r);
    double off = noise * rng.normal();
    for (Eigen::Index i = 0; i < one.rows(); ++i) {
      off = memory * off + noise * std::sqrt(1 - memory * memory) * rng.normal();
      one.outputs(0, i) = off;
    }
    recordings.push_back(std::move(one));
  }
  BoundSimulator bound = bind_simulator(Still{stated}, recordings);
  bound.integration.follow = follow;
  return bound;
}

/// What the true model leaves indeed.
WhitenessTest left_of(const BoundSimulator& bound) {
  const auto runs = simulate_all(bound, nominal_hypothesis(bound), all, bound.integration, serially());
  return test_whiteness(bound, all, runs, 0, 8, 80);
}

TEST_CASE("what noise leaves of predictions is told before: its size and how it is related") {
  for (const double memory : {0.0, 0.4}) {
    for (const double stated : {noise, 0.0}) {
      const BoundSimulator bound = read_with_noise(memory, 0.5, stated);
      const WhitenessTest left = left_of(bound);
      REQUIRE(left.rms > 1.05 * noise);
      const PredictionNoise told = prediction_noise(bound, nominal_hypothesis(bound), all, serially());
      CHECK(told.amplification[0] == doctest::Approx(left.rms / noise).epsilon(0.04));
      CHECK(std::abs(told.structure[0] - left.share * left.rms * left.rms) < 0.05 * noise * noise);
    }
  }
}

TEST_CASE("a trial that says noise leaves far more than recordings show is refuted") {
  const BoundSimulator bound = read_with_noise(0, 0.5, noise);
  const auto runs = simulate_all(bound, nominal_hypothesis(bound), all, bound.integration, serially());
  PredictionNoise told = prediction_noise(bound, nominal_hypothesis(bound), all, serially());
  CHECK_FALSE(is_refuted(told, bound, all, runs));
  told.amplification[0] *= 2;  // as of a motion that goes apart by noise, and theirs does not
  CHECK(is_refuted(told, bound, all, runs));
  CHECK_FALSE(is_refuted({}, bound, all, runs));
}

TEST_CASE("simulations that follow nothing leave the noise as it is") {
  const BoundSimulator bound = read_with_noise(0, 0, noise);
  CHECK(prediction_noise(bound, nominal_hypothesis(bound), all, serially()).amplification.size() == 0);
}

}  // namespace
}  // namespace surefoot::diagnosis
