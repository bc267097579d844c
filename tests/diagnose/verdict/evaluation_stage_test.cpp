// What is said about a model that was found.
#include "surefoot/diagnose/verdict/evaluation_stage.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "surefoot/diagnose/verdict/describe.hpp"
#include "surefoot/diagnose/verdict/pipeline.hpp"
#include "tests/diagnose/verdict/tank_setup.hpp"

namespace surefoot::diagnosis {
namespace {

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

}  // namespace
}  // namespace surefoot::diagnosis
