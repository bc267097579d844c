// The final check on held-out recordings.
#include "surefoot/diagnose/verdict/held_out_check.hpp"

#include <doctest/doctest.h>

#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

const HeldOutCriteria held_out_criteria;

TEST_CASE("effects are confirmed if they lower the error, and do not raise that of whole recordings") {
  CHECK(confirmed({1, 1}, {0.97, 1.01}, held_out_criteria));
  CHECK_FALSE(confirmed({1, 1}, {0.99, 0.5}, held_out_criteria));
  CHECK_FALSE(confirmed({1, 1}, {0.5, 1.03}, held_out_criteria));
}

Selection selection_of(const EstimationSetup& setup, const std::vector<NamedEffect>& effects) {
  Selection selection;
  selection.nominal.hypothesis = nominal_hypothesis(setup.bound);
  selection.chosen.hypothesis = toys::with_effects(setup, effects);
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
}

TEST_CASE("where nothing was chosen nothing is rejected") {
  const EstimationSetup setup = toys::tank_setup(toys::noisy_tanks({}, 0.01));
  const FittedModel calibrated = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  CHECK_FALSE(check_on_held_out(setup, calibrated, selection_of(setup, {}), held_out_criteria, serially()).rejected);
}

}  // namespace
}  // namespace surefoot::diagnosis
