// Errors of whole recordings.
#include "surefoot/diagnose/estimation/recording_error.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <vector>

#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::SlidingBlock;

TEST_CASE("errors are in units of the stated noise, or of the output's standard deviation") {
  Recording recording = toys::blank_recording(SlidingBlock{}.info(), 5, 0.1);
  recording.outputs.row(0) << 0, 1, -1, 1, -1;
  recording.outputs.row(1) << 0, 2, 2, 2, 2;
  BoundSimulator bound = bind_simulator(SlidingBlock{}, {recording});
  bound.info.outputs[1].noise = 0.5;
  const Eigen::VectorXd scale = error_scale(bound);
  CHECK(scale[0] == doctest::Approx(std::sqrt(0.8)));
  CHECK(scale[1] == 0.5);
  const SimulatedRun zero{Eigen::MatrixXd::Zero(2, 5), Eigen::MatrixXd::Zero(2, 5)};
  const double expected = std::sqrt((1 / 0.8 + 4 / 0.25) / 2);
  CHECK(recording_error(bound, 0, zero, scale) == doctest::Approx(expected));
  CHECK(error_over_all(bound, {0, 0}, {zero, zero}) == doctest::Approx(expected));
  CHECK(cell_counts(bound, {0}) == std::vector<double>{8});
}

TEST_CASE("the error over all recordings counts each as often as it has cells") {
  CHECK(over_all({1, 3}, {30, 10}) == doctest::Approx(std::sqrt((30 * 1 + 10 * 9) / 40.0)));
  CHECK(over_all({}, {}) == 0);
}

TEST_CASE("some recordings are those that are missed most, least and in between") {
  const Recording recording = toys::blank_recording(SlidingBlock{}.info(), 5, 0.1);
  const BoundSimulator bound = bind_simulator(SlidingBlock{}, std::vector<Recording>(5, recording));
  std::vector<SimulatedRun> runs;
  for (const double off : {3, 5, 1, 4}) {
    runs.push_back({Eigen::MatrixXd::Constant(2, 5, off), Eigen::MatrixXd::Zero(2, 5)});
  }
  const std::vector<std::size_t> recordings{4, 1, 2, 3};  // off by 3, 5, 1 and 4
  CHECK(some_by_error(bound, recordings, runs, 2) == std::vector<std::size_t>{1, 2});
  CHECK(some_by_error(bound, recordings, runs, 3) == std::vector<std::size_t>{1, 2, 3});
  CHECK(some_by_error(bound, recordings, runs, 1) == std::vector<std::size_t>{1});
  CHECK(some_by_error(bound, recordings, runs, 0).empty());
  CHECK(some_by_error(bound, recordings, runs, 4) == recordings);
}

}  // namespace
}  // namespace surefoot::diagnosis
