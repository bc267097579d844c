// The stages of a diagnosis together.
#include "surefoot/diagnose/verdict/pipeline.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/verdict/recording_stage.hpp"
#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("a fit that a search was too short for is finished") {
  DiagnoseOptions options;
  const Parallel parallel = serially();
  const RunContext run{options, parallel};
  EstimationSetup setup = hold_out_recordings(toys::bind_tank, toys::noisy_tanks({}, 0.01), run);
  setup.problem.weighting.sigma.setConstant(1, 0.01);
  Hypothesis chosen = nominal_hypothesis(setup.bound);
  chosen.parameters[0] *= 1.3;
  const auto error_of = [&](const Hypothesis& one) {
    const FitFunctions functions(setup.bound, one, setup.problem, parallel);
    return functions.residuals(functions.start()).squaredNorm();
  };
  const double cut_short = error_of(chosen);
  finish_fit(setup, chosen, run);
  CHECK(error_of(chosen) < 0.5 * cut_short);
}

TEST_CASE("the order in which recordings are given changes nothing") {
  DiagnoseOptions options;
  options.effects = {"constant_rate", "sensor_drift"};
  options.starts = 4;
  std::vector<Recording> recordings = toys::noisy_tanks(toys::extra_inflow(), 0.01, 7);
  const Diagnosis one = diagnose(toys::LeakyTank{}, recordings, options, Serial{}, 1);
  std::ranges::reverse(recordings);
  std::swap(recordings[1], recordings[4]);
  const Diagnosis other = diagnose(toys::LeakyTank{}, recordings, options, Serial{}, 1);
  CHECK(one.effects.size() == 1);
  CHECK(one.sentence == other.sentence);
  CHECK(one.held_out_after == other.held_out_after);
  CHECK(one.probability == other.probability);
  CHECK(one.held_out == other.held_out);
}

TEST_CASE("the pipeline names what is missing, and tells how far it is") {
  DiagnoseOptions options;
  options.effects = {"constant_rate", "sensor_drift"};
  options.starts = 4;
  std::vector<double> shares;
  options.on_progress = [&](std::string_view, double share, std::string_view) { shares.push_back(share); };
  const Diagnosis diagnosis =
      diagnose(toys::LeakyTank{}, toys::noisy_tanks(toys::extra_inflow(), 0.01), options, Serial{}, 1);
  CHECK(diagnosis.verdict == Verdict::missing_physics);
  REQUIRE(diagnosis.effects.size() == 1);
  CHECK(diagnosis.effects[0].name == "constant_rate");
  CHECK(diagnosis.effects[0].parameters[0].value == doctest::Approx(0.2).epsilon(0.1));
  CHECK(diagnosis.effects[0].evidence.confidence > 0.9);
  CHECK(diagnosis.effects[0].evidence.confidence >= diagnosis.probability);
  CHECK(diagnosis.probability > 0.5);
  CHECK(diagnosis.per_recording.size() == 6);
  CHECK(diagnosis.complete);
  CHECK(shares.front() == 0);
  CHECK(shares.back() == 1);
  for (std::size_t i = 1; i < shares.size(); ++i) CHECK(shares[i] >= shares[i - 1]);
}

TEST_CASE("effects that are part of the model already are calibrated with it, and not found again") {
  DiagnoseOptions options;
  options.effects = {"constant_rate", "sensor_drift"};
  options.known = {{"constant_rate", "level", {}, {}, {0.1}}};
  options.starts = 4;
  const Diagnosis diagnosis =
      diagnose(toys::LeakyTank{}, toys::noisy_tanks(toys::extra_inflow(), 0.01), options, Serial{}, 1);
  CHECK(diagnosis.effects.empty());
  CHECK_FALSE(diagnosis.limits.empty());
  REQUIRE(diagnosis.known_effects.size() == 1);
  CHECK(diagnosis.known_effects[0].parameters[0].value == doctest::Approx(0.2).epsilon(0.1));
}

}  // namespace
}  // namespace surefoot::diagnosis
