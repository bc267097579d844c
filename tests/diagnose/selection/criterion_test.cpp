// What is believed of hypotheses on held-out recordings, and what of their parameters.
#include "surefoot/diagnose/selection/criterion.hpp"

#include <doctest/doctest.h>

#include "surefoot/diagnose/effects/constant_rate.hpp"
#include "surefoot/diagnose/effects/sensor_drift.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

EvaluatedHypothesis evaluated(std::size_t parameters, double loss, double gain, double p) {
  EvaluatedHypothesis one;
  one.hypothesis.values.emplace_back(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters)));
  one.hypothesis.effects.emplace_back();
  for (int block = 0; block < 20; ++block) one.cross_validated.blocks.push_back(loss * (1 + 0.2 * (block % 3)));
  one.cross_validated.counts.assign(20, 60.0);
  one.gain = {.gain = gain, .stderr_ = 0.01, .t = gain / 0.01, .p_value = p};
  return one;
}

TEST_CASE("fewer parameters win a tie, and lose a clear case") {
  CHECK(most_plausible({evaluated(3, 1.00, 0.500, 1e-9), evaluated(1, 1.005, 0.499, 1e-9)}) == 1);
  CHECK(most_plausible({evaluated(3, 1.00, 0.500, 1e-9), evaluated(1, 2.00, 0.290, 1e-9)}) == 0);
}

TEST_CASE("a gain must be large enough and beyond chance, and the best that is not believed stands in nobody's way") {
  const SelectionCriteria options;
  CHECK(accepted({.gain = 0.3, .stderr_ = 0.02, .t = 15, .p_value = 1e-9}, 60, 1, options));
  CHECK_FALSE(accepted({.gain = 0.3, .stderr_ = 0.2, .t = 1.5, .p_value = 0.07}, 60, 1, options));
  CHECK_FALSE(accepted({.gain = 0.01, .stderr_ = 0.001, .t = 10, .p_value = 1e-9}, 60, 1, options));
  const auto choice =
      most_plausible_accepted({evaluated(1, 1.0, 0.5, 0.2), evaluated(1, 1.3, 0.4, 1e-9)}, 60, 1, options);
  REQUIRE(choice);
  CHECK(*choice == 1);
  CHECK_FALSE(most_plausible_accepted({evaluated(1, 1.0, 0.5, 0.2)}, 60, 1, options));
}

TEST_CASE("an effect whose parameter cannot be told from zero is not determined") {
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

TEST_CASE("few of many tests are passed by chance alone, so that each must be passed by more") {
  const SelectionCriteria criteria;
  const Comparison gain{.gain = 0.05, .stderr_ = 0.01, .t = 4, .p_value = 1e-3};
  CHECK(accepted(gain, 10, 1, criteria));
  CHECK_FALSE(accepted(gain, 100, 1, criteria));
  CHECK(accepted({.gain = 0.2, .stderr_ = 0.05, .t = 4, .p_value = 1e-2}, 100, 1, criteria));  // large: believed
}

TEST_CASE("what is gained of a small rest counts only if it is most of it") {
  const SelectionCriteria criteria;
  const Comparison some{.gain = 0.3, .stderr_ = 0.01, .t = 30, .p_value = 1e-12};
  CHECK(accepted(some, 60, 0.2, criteria));
  CHECK_FALSE(accepted(some, 60, 0.05, criteria));  // 1.5 % of the error without effects
  CHECK(accepted({.gain = 0.6, .stderr_ = 0.01, .t = 60, .p_value = 1e-12}, 60, 0.01, criteria));
}

TEST_CASE("an effect is idle if it gains little, or may have gained nothing") {
  const SelectionCriteria criteria;
  CHECK(idle({.gain = 0.01, .t = 9}, criteria));
  CHECK(idle({.gain = 0.2, .t = 1}, criteria));
  CHECK_FALSE(idle({.gain = 0.02, .t = 2}, criteria));
}

TEST_CASE("an effect is replaced by one that is clearly ahead, as measured by the error without effects too") {
  const SelectionCriteria criteria;
  CHECK(replaces({.gain = 0.05, .t = 3}, 0.5, criteria));
  CHECK_FALSE(replaces({.gain = 0.05, .t = 3}, 0.2, criteria));
  CHECK_FALSE(replaces({.gain = 0.05, .t = 1.9}, 0.5, criteria));
  CHECK_FALSE(replaces({.gain = 0.02, .t = 3}, 1, criteria));
}

TEST_CASE("of effects with as many parameters the one earlier in the catalogue is simpler") {
  Hypothesis early = evaluated(2, 1, 0, 1).hypothesis, late = early, longer = evaluated(3, 1, 0, 1).hypothesis;
  early.effects[0].rank = 1;
  late.effects[0].rank = 2;
  CHECK(simpler(early, late));
  CHECK_FALSE(simpler(late, early));
  CHECK(simpler(late, longer));
}

}  // namespace
}  // namespace surefoot::diagnosis
