// Cross-validated losses and their comparison: is a difference believed as often as it should be?
#include "surefoot/diagnose/estimation/cross_validation.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

BlockLosses losses_of(std::vector<double> blocks) {
  const std::vector<double> counts(blocks.size(), 60.0);
  return {std::move(blocks), counts};
}

// Share of 1000 repetitions in which two hypotheses that differ by chance only seem to differ at 5 %.
double rejections(std::size_t blocks, double spread, std::uint64_t seed) {
  Rng rng(seed);
  int rejected = 0;
  for (int k = 0; k < 1000; ++k) {
    std::vector<double> before, after;
    for (std::size_t i = 0; i < blocks; ++i) {
      const double hard = std::exp(spread * rng.normal());  // blocks differ much more than hypotheses
      before.push_back(hard * (1 + 0.1 * rng.uniform()));
      after.push_back(hard * (1 + 0.1 * rng.uniform()));
    }
    rejected += compare_losses(losses_of(before), losses_of(after)).p_value < 0.05 ? 1 : 0;
  }
  return rejected / 1000.0;
}

TEST_CASE("of hypotheses that are equally good, about one in twenty seems better at 5 %") {
  for (const auto& [blocks, spread] : {std::pair<std::size_t, double>{6, 0.3}, {12, 1.0}, {40, 0.5}, {40, 1.5}}) {
    const double share = rejections(blocks, spread, blocks);
    INFO(blocks << " blocks, spread " << spread << ": " << share);
    CHECK(share > 0.02);
    CHECK(share < 0.09);
  }
}

TEST_CASE("a hypothesis that is better everywhere is believed, and its gain is that of the root mean square") {
  const BlockLosses before = losses_of({100, 120, 80, 90, 300, 110, 95, 105}),
                    quarter = losses_of({25, 30, 20, 22.5, 75, 27.5, 23.75, 26.25});
  const Comparison better = compare_losses(before, quarter);
  CHECK(better.gain == doctest::Approx(0.5));
  CHECK(better.stderr_ == doctest::Approx(0));
  CHECK(better.p_value < 0.001);
  const Comparison worse = compare_losses(quarter, before);
  CHECK(worse.gain == doctest::Approx(-1));
  CHECK(worse.p_value > 0.99);
}

TEST_CASE("a gain that each recording has in a few of its blocks is believed") {
  Rng rng(3);
  BlockLosses before, after;
  for (int recording = 0; recording < 12; ++recording) {
    for (int block = 0; block < 8; ++block) {
      const double loss = 100 * (1 + 0.3 * rng.uniform());
      before.blocks.push_back(block == 0 ? loss + 60 : loss);
      after.blocks.push_back(100 * (1 + 0.3 * rng.uniform()));
      before.counts.push_back(60);
      after.counts.push_back(60);
    }
    before.ends.push_back(before.blocks.size());
    after.ends.push_back(after.blocks.size());
  }
  const double by_recording = compare_losses(before, after).p_value;
  before.ends.clear();
  CHECK(by_recording < 0.5 * compare_losses(before, after).p_value);
  CHECK(by_recording < 0.005);
}

TEST_CASE("one block alone convinces nobody, and no blocks do not either") {
  CHECK(compare_losses(losses_of({100, 100, 100, 900, 100, 100}), losses_of({101, 99, 100, 100, 99, 101})).p_value >
        0.05);
  CHECK(compare_losses(losses_of({100}), losses_of({1})).p_value == 1);
  CHECK(compare_losses({}, {}).p_value == 1);
}

TEST_CASE("the standard error of a gain is about its spread over repetitions") {
  Rng rng(5);
  double sum = 0, squares = 0, claimed = 0;
  constexpr int repetitions = 500;
  for (int k = 0; k < repetitions; ++k) {
    std::vector<double> before, after;
    for (int i = 0; i < 30; ++i) {
      before.push_back(100 * (1 + rng.uniform()));
      after.push_back(before.back() * (0.3 + 0.4 * rng.uniform()));
    }
    const Comparison one = compare_losses(losses_of(before), losses_of(after));
    sum += one.gain;
    squares += one.gain * one.gain;
    claimed += one.stderr_ / repetitions;
  }
  const double mean = sum / repetitions;
  CHECK(claimed == doctest::Approx(std::sqrt(squares / repetitions - mean * mean)).epsilon(0.15));
}

TEST_CASE("tails of Student's t agree with the tables") {
  CHECK(student_tail(1.645, 1e6) == doctest::Approx(0.05).epsilon(0.002));
  CHECK(student_tail(2.764, 10) == doctest::Approx(0.01).epsilon(0.01));
  CHECK(student_tail(2.015, 5) == doctest::Approx(0.05).epsilon(0.01));
  CHECK(student_tail(2.920, 2) == doctest::Approx(0.05).epsilon(0.05));
  CHECK(student_tail(-2.015, 5) == doctest::Approx(0.95).epsilon(0.01));
}

TEST_CASE("blocks share out all cells, and a simulation that ran away costs much but not everything") {
  BlockLosses losses;
  append_losses(losses, Eigen::VectorXd::Constant(1000, 0.5), 4);
  CHECK(losses.blocks.size() == 8);
  CHECK(losses.cells() == 1000);
  CHECK(losses.rms() == doctest::Approx(0.5));
  append_losses(losses, Eigen::VectorXd::Constant(30, std::numeric_limits<double>::infinity()), 4);
  CHECK(losses.blocks.size() == 9);
  CHECK(losses.total() == doctest::Approx(250 + 30e6));
}

TEST_CASE("a fold is evaluated by a fit that has not seen it") {
  std::vector<Recording> recordings;
  for (int r = 0; r < 3; ++r) {
    Recording recording = toys::tank_recording(r, 150);
    recording.outputs =
        simulate_augmented(toys::LeakyTank{}, toys::machine({r == 1 ? 3.0 : 1.5, 0.8}), recording).outputs;
    recordings.push_back(recording);
  }
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, recordings);
  FitProblem problem;
  problem.weighting.sigma.setConstant(1, 0.01);
  problem.weighting.robust = 1e6;
  problem.max_iterations = 40;
  problem.recordings = {0, 1, 2};
  const std::vector<Hypothesis> folds =
      fits_to_other_folds(bound, nominal_hypothesis(bound), problem, {{0}, {1}, {2}}, serially());
  REQUIRE(folds.size() == 3);
  CHECK(folds[1].parameters[0] == doctest::Approx(1.5).epsilon(1e-3));  // from recordings 0 and 2 only
  CHECK(folds[0].parameters[0] > 1.8);
  const auto runs = simulate_all(bound, folds[1], {1}, {}, serially());
  const BlockLosses losses = block_losses(bound, {1}, runs, problem.weighting);
  REQUIRE(losses.blocks.size() == 2);
  CHECK(losses.total() > 10 * 60);
}

}  // namespace
}  // namespace surefoot::diagnosis
