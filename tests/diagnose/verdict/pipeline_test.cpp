// The stages of a diagnosis, one by one and together.
#include "surefoot/diagnose/verdict/pipeline.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/verdict/describe.hpp"
#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("recordings are checked, freed of outliers, and remarked upon") {
  auto recordings = toys::noisy_tanks({}, 0.01, 2);
  recordings[1].outputs(0, 50) = 1000;
  const auto remarks = screen_recordings(toys::LeakyTank{}.info(), recordings);
  CHECK(std::isnan(recordings[1].outputs(0, 50)));
  REQUIRE_FALSE(remarks.empty());
  CHECK(remarks.front().recording == "tank 1");
  const auto of_lost_rows = [](const std::vector<Remark>& some) {
    return std::any_of(some.begin(), some.end(),
                       [](const Remark& one) { return one.text.find("rows are lost, 2 in all") == 0; });
  };
  CHECK_FALSE(of_lost_rows(remarks));
  recordings[0].time.tail(60).array() += 2 * (recordings[0].time[1] - recordings[0].time[0]);
  CHECK(of_lost_rows(screen_recordings(toys::LeakyTank{}.info(), recordings)));
  std::vector<Recording> none;
  CHECK_THROWS_AS(screen_recordings(toys::LeakyTank{}.info(), none), DiagnoseError);
}

TEST_CASE("few recordings are cut, unless those to hold out are named; one short recording is refused") {
  DiagnoseOptions options;
  options.starts = 2;
  const Parallel parallel = serially();
  const RunContext run{options, parallel};
  CHECK(cut_few_recordings(toys::bind_tank, toys::noisy_tanks({}, 0.01, 2), run).size() == 6);
  CHECK(cut_few_recordings(toys::bind_tank, toys::noisy_tanks({}, 0.01, 4), run).size() == 4);
  options.held_out = {"tank 1"};
  CHECK(cut_few_recordings(toys::bind_tank, toys::noisy_tanks({}, 0.01, 2), run).size() == 2);
  options.held_out = {};
  auto short_one = toys::noisy_tanks({}, 0.01, 1);
  short_one[0] = part_of(short_one[0], 0, 50, short_one[0].initial, short_one[0].initial_scale);
  CHECK_THROWS_AS(cut_few_recordings(toys::bind_tank, short_one, run), DiagnoseError);
}

TEST_CASE("where something is left it is said what was not tried") {
  const Parallel parallel = serially();
  const auto logs =
      toys::noisy_tanks({{"constant_rate", "level", {}, {}, {0.2}}, {"sensor_drift", "level_m", {}, {}, {0.3}}}, 0.01);
  const DiagnoseOptions options{.effects = {"sensor_scale", "constant_rate"}, .max_effects = 1};
  const Diagnosis diagnosis = run_pipeline(toys::bind_tank, toys::LeakyTank{}.info(), logs, options, parallel, 1, {});
  REQUIRE(diagnosis.verdict == Verdict::unexplained);
  REQUIRE(diagnosis.effects.size() == 1);
  const auto said = [&](const std::string& text) {
    return std::any_of(diagnosis.remarks.begin(), diagnosis.remarks.end(),
                       [&](const Remark& one) { return one.text == text; });
  };
  CHECK(said(no_speed_sentence()));
  CHECK(said(most_effects_sentence(1)));
}

TEST_CASE("what is held out takes no part in the fit") {
  DiagnoseOptions options;
  options.held_out = {"tank 2"};
  const Parallel parallel = serially();
  const EstimationSetup setup = hold_out_recordings(toys::bind_tank, toys::noisy_tanks({}, 0.01), {options, parallel});
  CHECK(setup.split.held_out == std::vector<std::size_t>{2});
  CHECK(setup.problem.recordings == std::vector<std::size_t>{0, 1, 3, 4, 5});
}

TEST_CASE("the search leaves time for fits without each held-out recording, and it is said where these were not made") {
  DiagnoseOptions options;
  options.max_seconds = 100;
  const Parallel parallel = serially();
  RunContext run{options, parallel};
  run.began -= std::chrono::seconds(90);
  CHECK(run.search_has_ended());
  CHECK_FALSE(run.has_ended());
  run.began -= std::chrono::seconds(11);
  CHECK(run.has_ended());

  options.max_seconds = 1e-9;
  const Diagnosis late =
      run_pipeline(toys::bind_tank, toys::LeakyTank{}.info(), toys::noisy_tanks({}, 0.01), options, parallel, 1, {});
  const auto says_so = [](const Remark& one) { return one.text == not_held_out_sentence(); };
  CHECK(std::ranges::any_of(late.remarks, says_so));
  CHECK_FALSE(late.complete);
}

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

TEST_CASE("by default every recording is for the fit, and held out once") {
  DiagnoseOptions options;
  const Parallel parallel = serially();
  const EstimationSetup setup = hold_out_recordings(toys::bind_tank, toys::noisy_tanks({}, 0.01), {options, parallel});
  CHECK(setup.split.cross_fitted);
  CHECK(setup.split.training.size() == 6);
  Diagnosis diagnosis;
  name_recordings(setup, diagnosis);
  CHECK(diagnosis.fit.size() == 6);
  CHECK(diagnosis.held_out == diagnosis.fit);
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
