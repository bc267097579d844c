// Evidence measured on tanks whose truth the test knows.
#include "surefoot/diagnose/verdict/evidence.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

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

// Whether a held-out recording with this error [of the noise] and so many independent errors is marked.
bool marked(double error, double independent, double noise_ratio = 1) {
  Diagnosis diagnosis;
  diagnosis.noise_floor = 0.5;
  diagnosis.noise_ratio = noise_ratio;
  diagnosis.per_recording = {{"usual", 1, 0.5, 0.5, 100}, {"asked", 1, 0.5 * error, 0.5 * error, independent}};
  mark_beyond_noise(diagnosis, {});
  CHECK_FALSE(diagnosis.per_recording[0].beyond_noise);
  return diagnosis.per_recording[1].beyond_noise;
}

TEST_CASE("a recording is beyond the noise if its error is large, and surely so") {
  const VerdictCriteria criteria;
  const double large = criteria.largest_ratio;
  CHECK(marked(1.01 * large, 1e4));
  CHECK_FALSE(marked(0.99 * large, 1e9));  // sure, but small
  CHECK(marked(1.05 * large, 40));
  CHECK_FALSE(marked(1.05 * large, 15));  // large, but may be chance
  CHECK_FALSE(marked(2.5, 1));
  CHECK_FALSE(marked(0.1, 1e4));
}

TEST_CASE("the lower bound of a mean square is lower where errors are few, and where recordings differ") {
  const auto of_equal = [](double count, double deviations) {
    return lower_mean_square({4 * count, 4 * count, 4 * count, 4 * count}, {count, count, count, count}, deviations);
  };
  CHECK(of_equal(100, 0) == 4);
  CHECK(of_equal(100, 3) == doctest::Approx(4 * (1 - 3 * std::sqrt(4 / 400.0))));
  CHECK(of_equal(400, 3) > of_equal(100, 3));
  CHECK(lower_mean_square({100, 100, 100, 1300}, {100, 100, 100, 100}, 1) < 0.5);  // one recording may be all of it
  CHECK(lower_mean_square({4e6}, {1e6}, 1) == doctest::Approx(4).epsilon(0.01));
}

TEST_CASE("the process noise says nothing of measurement noise, and nothing where it is not stated") {
  EstimationSetup setup = toys::tank_setup(toys::noisy_tanks({}, 0.01));
  const FittedModel model = fitted_model(setup, nominal_hypothesis(setup.bound), serially());
  for (OutputInfo& output : setup.bound.info.outputs) output.process_noise = 0.01;
  CHECK(std::isnan(process_ratio(setup, model.runs.training, {})));
  setup.noise = NoiseKind::process;
  const double ratio = process_ratio(setup, model.runs.training, {});
  CHECK(ratio < 1.1);
  for (OutputInfo& output : setup.bound.info.outputs) output.process_noise = 0.005;
  CHECK(process_ratio(setup, model.runs.training, {}) == doctest::Approx(4 * ratio));
  setup.bound.info.outputs[0].process_noise = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(process_ratio(setup, model.runs.training, {})));
}

TEST_CASE("where the noise is unknown no recording is beyond it") {
  CHECK_FALSE(marked(100, 1e4, std::numeric_limits<double>::quiet_NaN()));
}

TEST_CASE("recordings beyond the noise are counted as evidence, and are unexplained") {
  auto recordings = toys::noisy_tanks(toys::extra_inflow(), 0.01);
  for (double& level : recordings[5].outputs.reshaped()) level *= 1.2;
  const EstimationSetup setup = toys::tank_setup(recordings);
  const FittedModel model = fitted_model(setup, toys::with_effects(setup, toys::extra_inflow()), serially());
  const FittedModels models{model, model, model};
  Diagnosis diagnosis;
  evaluate_errors(setup, models, diagnosis, 1);
  mark_beyond_noise(diagnosis, {});
  REQUIRE(diagnosis.per_recording.size() == 2);
  CHECK_FALSE(diagnosis.per_recording[0].beyond_noise);
  CHECK(diagnosis.per_recording[1].beyond_noise);
  const VerdictEvidence evidence = gather_evidence(setup, models, diagnosis, {}, {}, serially(), 1);
  CHECK(evidence.recordings_beyond_noise == 1);
  CHECK(decide(evidence, {}) == Verdict::unexplained);
}

}  // namespace
}  // namespace surefoot::diagnosis
