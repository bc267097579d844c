// Noise by the fast part of residuals: white, fading, and beneath errors of a model.
#include "surefoot/diagnose/residual_tests/noise_spectrum.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "tests/diagnose/estimation/noisy_tanks.hpp"

namespace surefoot::diagnosis {
namespace {

// Four series of so many rows: noise of standard deviation 1 that keeps `memory` from row to row, and an error.
std::vector<Eigen::VectorXd> noisy(double memory, const std::function<double(Eigen::Index)>& error,
                                   Eigen::Index rows = 400) {
  std::vector<Eigen::VectorXd> all;
  for (std::uint64_t r = 0; r < 4; ++r) {
    Rng rng(5, r);
    Eigen::VectorXd series(rows);
    double noise = rng.normal();
    for (Eigen::Index i = 0; i < rows; ++i) {
      noise = memory * noise + std::sqrt(1 - memory * memory) * rng.normal();
      series[i] = noise + error(i);
    }
    all.push_back(series);
  }
  return all;
}

double noise_of_series(const std::vector<Eigen::VectorXd>& series) {
  return noise_from_spectrum(fast_spectrum(series)).deviation;
}

TEST_CASE("noise is found beneath slow errors that are many times as large, white or fading from row to row") {
  for (const double memory : {0.0, 0.3, 0.6}) {
    CHECK(noise_of_series(noisy(memory, [](auto) { return 0.0; })) == doctest::Approx(1).epsilon(0.15));
    const auto slow = [](auto i) { return 30 * std::sin(0.05 * static_cast<double>(i)); };
    CHECK(noise_of_series(noisy(memory, slow)) == doctest::Approx(1).epsilon(0.15));
    auto jumps = noisy(memory, [](auto) { return 0.0; });
    for (Eigen::Index i = 170; i < jumps[2].size(); ++i) jumps[2][i] += 40;
    CHECK(noise_of_series(jumps) == doctest::Approx(1).epsilon(0.2));
  }
}

TEST_CASE("what noise keeps from row to row is found") {
  for (const double memory : {0.0, 0.3, 0.6}) {
    const FadingNoise noise = noise_from_spectrum(fast_spectrum(noisy(memory, [](auto) { return 0.0; })));
    CHECK(std::abs(noise.rho - memory) < 0.15);
    CHECK_FALSE(noise.slow);
  }
}

TEST_CASE("errors that walk at random are no noise of a sensor") {
  std::vector<Eigen::VectorXd> all = noisy(0, [](auto) { return 0.0; });
  for (Eigen::VectorXd& series : all) {
    for (Eigen::Index i = 1; i < series.size(); ++i) series[i] += series[i - 1];
  }
  CHECK(noise_from_spectrum(fast_spectrum(all)).slow);
  CHECK(noise_of_series(all) < 1);  // what is new in a row, where the whole is some ten times that
}

TEST_CASE("too few rows tell nothing") {
  CHECK(fast_spectrum(noisy(
                          0, [](auto) { return 0.0; }, 66))
            .power.empty());
  CHECK(noise_of_series({}) == 0);
  CHECK(noise_of_series({Eigen::VectorXd::Zero(1000)}) == 0);
}

TEST_CASE("readings that are missing are filled in between, recordings of which many miss are left out") {
  std::vector<Recording> recordings = tanks(2, 40, 1, 1);
  recordings[0].outputs(0, 10) = recordings[0].outputs(0, 11) = std::numeric_limits<double>::quiet_NaN();
  for (Eigen::Index i = 1; i < 40; i += 2) recordings[1].outputs(0, i) = std::numeric_limits<double>::quiet_NaN();
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, recordings);
  const auto runs = simulate_all(bound, nominal_hypothesis(bound), {0, 1}, bound.integration, serially());
  std::vector<SimulatedRun> off = runs;
  for (Eigen::Index i = 0; i < 40; ++i) off[0].outputs(0, i) += static_cast<double>(i);
  const std::vector<Eigen::VectorXd> series = filled_series(bound, {0, 1}, off, 0);
  REQUIRE(series.size() == 1);
  for (Eigen::Index i = 0; i < 40; ++i) CHECK(series[0][i] == doctest::Approx(static_cast<double>(i)));
}

}  // namespace
}  // namespace surefoot::diagnosis
