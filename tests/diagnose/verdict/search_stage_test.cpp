// The search as a stage: its candidates, its subject, and how long it goes on.
#include "surefoot/diagnose/verdict/search_stage.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/verdict/recording_stage.hpp"
#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("candidates are the effects that were asked for, at every place that they fit") {
  DiagnoseOptions options;
  options.effects = {"constant_rate", "sensor_bias", "wind"};
  options.more_effects = {{.name = "wind", .place = Place::state}};
  options.starts = 2;
  const Parallel parallel = serially();
  const RunContext run{options, parallel};
  EstimationSetup setup = hold_out_recordings(toys::bind_tank, toys::noisy_tanks({}, 0.01), run);
  const Calibration calibration = calibrate_model(setup, run);
  std::string labels;
  for (const AttachedEffect& one : candidate_effects(setup, calibration, run)) labels += one.label() + "; ";
  CHECK(labels.find("constant_rate at level; ") != std::string::npos);
  CHECK(labels.find("sensor_bias at level_m; ") != std::string::npos);
  CHECK(labels.find("wind at level; ") != std::string::npos);
  CHECK(labels.find("leak") == std::string::npos);
  setup.noise = NoiseKind::process;  // rows start from readings: no fault of a sensor can be seen
  for (const AttachedEffect& one : candidate_effects(setup, calibration, run)) {
    CHECK(one.effect->place != Place::output);
  }
}

TEST_CASE("small problems get a longer list of proposals, and the search ends when its time is over") {
  DiagnoseOptions options;
  const Parallel parallel = serially();
  options.starts = 2;
  EstimationSetup setup = hold_out_recordings(toys::bind_tank, toys::noisy_tanks({}, 0.01), {options, parallel});
  const Calibration calibration = calibrate_model(setup, {options, parallel});
  const SearchProblem problem = search_problem(setup, calibration, {options, parallel});
  CHECK(problem.effort.shortlist == SearchEffort{}.max_shortlist);
  CHECK(problem.screened == setup.split.training);  // of few rows each recording shows something of its own
  CHECK(problem.scale.sigma == error_scale(setup.bound));
  CHECK(problem.nominal.parameters == calibration.nominal.parameters);
  CHECK_FALSE(problem.stopped());
  options.max_seconds = 1e-9;
  CHECK(search_problem(setup, calibration, {options, parallel}).stopped());
}

TEST_CASE("of many rows a few recordings make proposals") {
  DiagnoseOptions options;
  const Parallel parallel = serially();
  options.starts = 2;
  const int count = static_cast<int>(SearchEffort{}.screening_rows / 120) + 5;  // of 120 rows, some of them held out
  EstimationSetup setup = hold_out_recordings(toys::bind_tank, toys::noisy_tanks({}, 0.01, count), {options, parallel});
  const Calibration calibration = calibrate_model(setup, {options, parallel});
  CHECK(search_problem(setup, calibration, {options, parallel}).screened.size() == SearchEffort{}.screening);
}

TEST_CASE("residuals are searched for more as long as they hold what noise does not") {
  DiagnoseOptions options;
  options.starts = 2;
  const Parallel parallel = serially();
  EstimationSetup setup =
      hold_out_recordings(toys::bind_tank, toys::noisy_tanks(toys::extra_inflow(), 0.01), {options, parallel});
  const Calibration calibration = calibrate_model(setup, {options, parallel});
  const SearchProblem problem = search_problem(setup, calibration, {options, parallel});
  CHECK(problem.structured(calibration.calibrated.hypothesis, problem.fit));
  CHECK_FALSE(problem.structured(toys::with_effects(setup, toys::extra_inflow()), problem.fit));
}

TEST_CASE("what a structure leaves of recordings that it was not fitted to says nothing of it") {
  DiagnoseOptions options;
  options.starts = 2;
  const Parallel parallel = serially();
  std::vector<Recording> recordings = toys::noisy_tanks({}, 0.01);
  const Recording other = toys::noisy_tanks(toys::extra_inflow(), 0.01).back();
  recordings.back().outputs = other.outputs;
  EstimationSetup setup = hold_out_recordings(toys::bind_tank, std::move(recordings), {options, parallel});
  const Calibration calibration = calibrate_model(setup, {options, parallel});
  const SearchProblem problem = search_problem(setup, calibration, {options, parallel});
  const Hypothesis truth = toys::with_effects(setup, {});
  CHECK(problem.structured(truth, problem.fit));
  FitProblem without_it = problem.fit;
  std::erase_if(without_it.recordings,
                [&](std::size_t r) { return setup.bound.recordings[r].outputs == other.outputs; });
  REQUIRE(without_it.recordings.size() + 1 == problem.fit.recordings.size());
  CHECK_FALSE(problem.structured(truth, without_it));
}

}  // namespace
}  // namespace surefoot::diagnosis
