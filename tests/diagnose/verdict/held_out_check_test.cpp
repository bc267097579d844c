// The final check on held-out recordings.
#include "surefoot/diagnose/verdict/held_out_check.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

const HeldOutCriteria held_out_criteria;

TEST_CASE("effects are confirmed if they lower the error, and do not raise that of whole recordings") {
  const double less = held_out_criteria.error_ratio, whole = held_out_criteria.whole_error_ratio;
  CHECK(confirmed({2, 3}, {2 * less - 0.01, 3 * whole - 0.01}, held_out_criteria));
  CHECK_FALSE(confirmed({2, 3}, {2 * less + 0.01, 1.5}, held_out_criteria));
  CHECK_FALSE(confirmed({2, 3}, {1, 3 * whole + 0.01}, held_out_criteria));
}

Selection selection_of(const EstimationSetup& setup, const std::vector<NamedEffect>& effects) {
  Selection selection;
  selection.nominal.hypothesis = nominal_hypothesis(setup.bound);
  selection.chosen.hypothesis = toys::with_effects(setup, effects);
  selection.evidence.resize(effects.size());
  selection.probability = effects.empty() ? 1 : 0.9;
  if (!effects.empty()) {
    selection.alternatives = {selection.nominal};
    selection.alternative_probabilities = {0.1};
  }
  return selection;
}

TEST_CASE("a choice that held-out recordings confirm is kept") {
  const EstimationSetup setup = toys::tank_setup(toys::noisy_tanks(toys::extra_inflow(), 0.01));
  const FittedModel calibrated = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  const CheckedChoice choice =
      check_on_held_out(setup, calibrated, selection_of(setup, toys::extra_inflow()), held_out_criteria, serially());
  CHECK_FALSE(choice.rejected);
  CHECK(choice.chosen.hypothesis.effects.size() == 1);
  CHECK(held_out_errors(setup, choice.chosen).weighted < 0.3 * held_out_errors(setup, calibrated).weighted);
}

TEST_CASE("a choice that they do not confirm is rejected, and becomes the alternative to none") {
  const EstimationSetup setup = toys::tank_setup(toys::noisy_tanks({}, 0.01));
  const FittedModel calibrated = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  const CheckedChoice choice =
      check_on_held_out(setup, calibrated, selection_of(setup, toys::extra_inflow()), held_out_criteria, serially());
  CHECK(choice.rejected);
  CHECK(choice.chosen.hypothesis.effects.empty());
  CHECK(choice.selection.chosen.hypothesis.effects.empty());
  REQUIRE(choice.selection.alternatives.size() == 1);
  CHECK(choice.selection.alternatives[0].hypothesis.effects[0].effect->name == "constant_rate");
  CHECK(choice.selection.alternative_probabilities == std::vector<double>{0.9});
  CHECK(choice.selection.probability == 0.1);
  CHECK(choice.selection.evidence.empty());
}

TEST_CASE("recordings that are each held out once can reject as well") {
  const auto checked = [](const std::vector<NamedEffect>& truth) {
    EstimationSetup setup = toys::tank_setup(toys::noisy_tanks(truth, 0.01));
    setup.split = {{0, 1, 2, 3, 4, 5}, {0, 1, 2, 3, 4, 5}, {{0, 1, 2}, {3, 4, 5}}, true};
    setup.problem.recordings = setup.split.training;
    const FittedModel calibrated = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
    return check_on_held_out(setup, calibrated, selection_of(setup, toys::extra_inflow()), held_out_criteria,
                             serially());
  };
  CHECK_FALSE(checked(toys::extra_inflow()).rejected);
  CHECK(checked({}).rejected);
}

TEST_CASE("where nothing was chosen nothing is rejected") {
  const EstimationSetup setup = toys::tank_setup(toys::noisy_tanks({}, 0.01));
  const FittedModel calibrated = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  CHECK_FALSE(check_on_held_out(setup, calibrated, selection_of(setup, {}), held_out_criteria, serially()).rejected);
}

}  // namespace
}  // namespace surefoot::diagnosis
