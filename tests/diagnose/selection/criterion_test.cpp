// What is believed of hypotheses on held-out recordings, and what of their numbers.
#include "surefoot/diagnose/selection/criterion.hpp"

#include <doctest/doctest.h>

#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/effects/constant_rate.hpp"
#include "surefoot/diagnose/effects/sensor_drift.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

EvaluatedHypothesis judged(std::size_t numbers, double loss, double gain, double p) {
  EvaluatedHypothesis one;
  one.hypothesis.values.emplace_back(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(numbers)));
  one.hypothesis.effects.emplace_back();
  for (int block = 0; block < 20; ++block) one.heldout.blocks.push_back(loss * (1 + 0.2 * (block % 3)));
  one.heldout.counts.assign(20, 60.0);
  one.gain = {.gain = gain, .stderr_ = 0.01, .t = gain / 0.01, .p_value = p};
  return one;
}

TEST_CASE("fewer numbers win a tie, and lose a clear case") {
  CHECK(most_plausible({judged(3, 1.00, 0.500, 1e-9), judged(1, 1.005, 0.499, 1e-9)}) == 1);
  CHECK(most_plausible({judged(3, 1.00, 0.500, 1e-9), judged(1, 2.00, 0.290, 1e-9)}) == 0);
}

TEST_CASE("a gain must be large enough and beyond chance, and the best that is not believed stands in nobody's way") {
  const SelectionCriteria options;
  CHECK(accepted({.gain = 0.3, .stderr_ = 0.02, .t = 15, .p_value = 1e-9}, 60, 1, options));
  CHECK_FALSE(accepted({.gain = 0.3, .stderr_ = 0.2, .t = 1.5, .p_value = 0.07}, 60, 1, options));
  CHECK_FALSE(accepted({.gain = 0.01, .stderr_ = 0.001, .t = 10, .p_value = 1e-9}, 60, 1, options));
  const auto choice = most_plausible_accepted({judged(1, 1.0, 0.5, 0.2), judged(1, 1.3, 0.4, 1e-9)}, 60, 1, options);
  REQUIRE(choice);
  CHECK(*choice == 1);
  CHECK_FALSE(most_plausible_accepted({judged(1, 1.0, 0.5, 0.2)}, 60, 1, options));
}

TEST_CASE("an effect whose number cannot be told from zero is not determined") {
  std::vector<Recording> recordings{toys::tank_recording(0, 200), toys::tank_recording(1, 200)};
  Rng rng(1);
  for (Recording& recording : recordings) {
    recording.outputs =
        simulate_augmented(toys::LeakyTank{}, toys::machine({1, 1}, {{"constant_rate", "level", {}, {}, {0.2}}}),
                           recording)
            .outputs;
    for (double& value : recording.outputs.reshaped()) value += 0.02 * rng.normal();
  }
  const BoundSimulator bound = bind_simulator(toys::LeakyTank{}, recordings);
  FitProblem problem;
  problem.recordings = {0, 1};
  problem.weighting.sigma.setConstant(1, 0.02);
  Hypothesis start = nominal_hypothesis(bound);
  start.effects = attachments(bound, {effects::constant_rate()}, {});
  start.values.emplace_back(Eigen::VectorXd::Constant(1, 0.1));
  CHECK(determined(bound, fit(bound, start, problem, serially()).hypothesis, 0, problem, serially()));
  start.effects.push_back(attachments(bound, {effects::sensor_drift()}, {}).front());
  start.values.emplace_back(Eigen::VectorXd::Constant(1, 0.0));
  const Hypothesis both = fit(bound, start, problem, serially()).hypothesis;
  CHECK_FALSE(determined(bound, both, 0, problem, serially()));
  CHECK(determined(bound, both, 2, problem, serially()));  // what is known already is not questioned
}

}  // namespace
}  // namespace surefoot::diagnosis
