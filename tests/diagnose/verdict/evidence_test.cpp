// Evidence measured on tanks whose truth the test knows.
#include "surefoot/diagnose/verdict/evidence.hpp"

#include <doctest/doctest.h>

#include "surefoot/diagnose/verdict/evaluate.hpp"
#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

VerdictEvidence evidence_of(const std::vector<NamedEffect>& truth, const std::vector<NamedEffect>& named) {
  const EstimationSetup setup = toys::tank_setup(toys::noisy_tanks(truth, 0.01));
  const FittedModel plain = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  const FittedModels models{plain, plain, fitted_model(setup, toys::with_effects(setup, named), serially())};
  Diagnosis diagnosis;
  evaluate_errors(setup, models, diagnosis, 1);
  return gather_evidence(setup, models, diagnosis, {.gain = 0.1, .t = 5}, {}, serially(), 1);
}

TEST_CASE("what is named leaves no structure, and what is not named leaves all of it") {
  const VerdictEvidence named = evidence_of(toys::extra_inflow(), toys::extra_inflow()),
                        missed = evidence_of(toys::extra_inflow(), {});
  CHECK(named.effects_found);
  CHECK(named.structure_energy < 0.05);
  CHECK(named.noise_ratio < 1.2);
  CHECK_FALSE(missed.effects_found);
  CHECK(missed.structure_energy == doctest::Approx(1));
  CHECK(missed.structure_p_value < 1e-3);
  CHECK(decide(named, {}) == Verdict::missing_physics);
  CHECK(decide(missed, {}) == Verdict::unexplained);
}

TEST_CASE("what the calibration gained is handed on") {
  const VerdictEvidence evidence = evidence_of({}, {});
  CHECK(evidence.calibration_gain == 0.1);
  CHECK(decide(evidence, {}) == Verdict::parameters_only);
}

}  // namespace
}  // namespace surefoot::diagnosis
