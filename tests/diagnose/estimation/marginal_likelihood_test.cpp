// Parts of the marginal likelihood: errors, how many of them are independent, and what parameters cost.
#include "surefoot/diagnose/estimation/marginal_likelihood.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "tests/diagnose/estimation/noisy_tanks.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::LeakyTank, toys::SlidingBlock;

// Noise that is correlated by `memory` from row to row.
Eigen::VectorXd noise(Eigen::Index rows, double memory, std::uint64_t seed) {
  Rng rng(seed);
  Eigen::VectorXd series(rows);
  double value = rng.normal();
  for (double& one : series) one = value = memory * value + std::sqrt(1 - memory * memory) * rng.normal();
  return series;
}

TEST_CASE("the root mean square is that of all cells, and 0 without any") {
  const ErrorSquares errors{Eigen::MatrixXd{{1, 4}, {9, 0}}, Eigen::MatrixXd{{10, 20}, {30, 0}},
                            Eigen::VectorXd::Ones(2)};
  CHECK(errors.rms() == doctest::Approx(std::sqrt((10 * 1 + 20 * 4 + 30 * 9) / 60.0)));
  CHECK_FALSE(errors.empty());
  CHECK(ErrorSquares{}.empty());
  CHECK(ErrorSquares{}.rms() == 0);
}

TEST_CASE("white noise forgets at once, and correlated noise after (1 + a) / (1 - a) rows") {
  for (const double memory : {0.0, 0.5, 0.9}) {
    const double rows = (1 + memory) / (1 - memory);
    const double time = autocorrelation_time({noise(20000, memory, 1), noise(20000, memory, 2)});
    INFO("memory " << memory << ", time " << time);
    CHECK(time >= 1);
    CHECK(time == doctest::Approx(rows).epsilon(0.25));
  }
}

TEST_CASE("a time is that of many short series as well as that of a long one") {
  std::vector<Eigen::VectorXd> series;
  for (std::uint64_t k = 0; k < 100; ++k) series.push_back(noise(200, 0.8, k));
  CHECK(autocorrelation_time(series) == doctest::Approx(9).epsilon(0.25));
}

TEST_CASE("errors that oscillate or never change are remembered for long, but not for ever") {
  constexpr Eigen::Index rows = 2000;
  Eigen::VectorXd wave(rows);
  for (Eigen::Index i = 0; i < rows; ++i) wave[i] = std::sin(2 * std::numbers::pi * static_cast<double>(i) / 20);
  const std::vector<Eigen::VectorXd> lasting{wave, Eigen::VectorXd::Ones(rows)};
  for (const Eigen::VectorXd& series : lasting) {
    const double time = autocorrelation_time({series});
    CHECK(time > 0.1 * static_cast<double>(rows));
    CHECK(time < static_cast<double>(rows));
  }
}

TEST_CASE("nothing, and nothing but zeros, counts as if it forgot at once") {
  CHECK(autocorrelation_time({}) == 1);
  CHECK(autocorrelation_time({Eigen::VectorXd(), Eigen::VectorXd::Zero(100)}) == 1);
  CHECK(autocorrelation_time({Eigen::VectorXd::Ones(1)}) == 1);
}

TEST_CASE("errors are counted by recording and output, in units of the scale; what was not measured does not count") {
  Recording recording = toys::blank_recording(SlidingBlock{}.info(), 5, 0.1);
  recording.outputs.row(0) << 0, 1, std::numeric_limits<double>::quiet_NaN(), 1, -2;
  recording.outputs.row(1) << 0, 3, 3, 3, 3;
  const BoundSimulator bound = bind_simulator(SlidingBlock{}, {recording, recording});
  Weighting scale;
  scale.sigma = Vec<2>(1, 2);
  const ErrorSquares errors = error_squares(bound, nominal_hypothesis(bound), {1, 0}, {}, scale, serially());
  CHECK(errors.counts == Eigen::MatrixXd{{3, 4}, {3, 4}});
  CHECK(errors.mean_squares(0, 0) == doctest::Approx(2));
  CHECK(errors.mean_squares(1, 1) == doctest::Approx(9.0 / 4));
  CHECK(errors.memory.size() == 2);
  CHECK(errors.memory.minCoeff() >= 1);
}

TEST_CASE("a simulation that ran away is off by much, but by a finite amount") {
  const BoundSimulator bound = bind_simulator(SlidingBlock{}, {toys::blank_recording(SlidingBlock{}.info(), 5, 0.1)});
  Hypothesis hypothesis = nominal_hypothesis(bound);
  hypothesis.initial[0][1] = std::numeric_limits<double>::infinity();
  Weighting scale;
  scale.sigma = Eigen::VectorXd::Ones(2);
  const ErrorSquares errors = error_squares(bound, hypothesis, {0}, {}, scale, serially());
  CHECK(errors.rms() > 1e5);
  CHECK(std::isfinite(errors.rms()));
  CHECK(errors.memory == Eigen::VectorXd::Ones(2));
}

// The cost of the parameters of some tanks.
double cost(std::vector<Recording> recordings, const std::vector<bool>& fixed = {false, false}) {
  BoundSimulator bound = bind_simulator(LeakyTank{}, std::move(recordings));
  for (std::size_t k = 0; k < fixed.size(); ++k) bound.info.parameters[k].fixed = fixed[k];
  return log_occam_factor(bound, nominal_hypothesis(bound), problem_of(bound.recordings.size(), 0.02), 0, serially());
}

// Recordings in which nothing flows, so that only noise is read.
std::vector<Recording> empty_tanks() {
  auto recordings = tanks(4, 200, 1, 1, 0.02);
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    recordings[r].inputs.setZero();
    recordings[r].outputs.row(0) = 0.02 * noise(200, 0, r).transpose();
  }
  return recordings;
}

TEST_CASE("the more recordings determine parameters, the more these cost: half a log of the data each") {
  const double few = cost(tanks(2, 200, 1, 1, 0.02)), many = cost(tanks(32, 200, 1, 1, 0.02));
  CHECK(few < 0);
  CHECK(few - many == doctest::Approx(0.5 * 2 * std::log(16)).epsilon(0.15));
}

TEST_CASE("a parameter that nothing determines costs nothing, and neither does one that is fixed") {
  CHECK(cost(empty_tanks()) == doctest::Approx(0));
  CHECK(cost(tanks(4, 200, 1, 1, 0.02), {true, true}) == 0);
  const double both = cost(tanks(4, 200, 1, 1, 0.02)), one = cost(tanks(4, 200, 1, 1, 0.02), {false, true});
  CHECK(one < 0);
  CHECK(both < one);
}

TEST_CASE("the prior of a size is as dense for every order of magnitude, that of a parameter for every value") {
  Variable size{.kind = Variable::Kind::effect, .low = 0, .high = 3};
  CHECK(prior_width(size, 0.6) / prior_width(size, 0.3) == doctest::Approx(2).epsilon(0.1));
  CHECK(prior_width(size, 0) > 0);  // a hundredth of the largest is as good as none
  CHECK(prior_width(size, 0) < 0.05 * prior_width(size, 3));
  CHECK(prior_width(size, 3) <= 1.5);
  Variable signed_size = size;
  signed_size.low = -3;
  CHECK(prior_width(signed_size, -0.3) == prior_width(signed_size, 0.3));
  CHECK(prior_width(signed_size, 0.3) == doctest::Approx(2 * prior_width(size, 0.3)));
  Variable parameter = size;
  parameter.kind = Variable::Kind::parameter;
  CHECK(prior_width(parameter, 0.01) == 1.5);
}

TEST_CASE("noise that is larger, or correlated, leaves parameters less determined, which costs less") {
  const double plain = cost(tanks(4, 200, 1, 1, 0.02));
  CHECK(cost(tanks(4, 200, 1, 1, 0.2)) > plain + std::log(10));
  CHECK(cost(tanks(4, 200, 1, 1, 0.02, 0.9)) > plain + 0.5 * std::log(10));
}

TEST_CASE("what an unknown initial state could do as well says nothing of a parameter") {
  auto known = empty_tanks();
  for (Recording& recording : known) {
    recording.initial.setConstant(1);
    for (Eigen::Index i = 0; i < recording.rows(); ++i) recording.outputs(0, i) += std::exp(-recording.time[i]);
  }
  auto unknown = known;
  for (Recording& recording : unknown) recording.initial_scale.setConstant(0.1);
  CHECK(cost(known) < -1);  // the leak is seen
  CHECK(cost(unknown) > cost(known) + 0.1);
  CHECK(cost(unknown) < -1);  // it still is, as a level and its decay differ
}

}  // namespace
}  // namespace surefoot::diagnosis
