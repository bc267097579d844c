// Recordings as a diagnosis takes them.
#include "surefoot/diagnose/verdict/recording_stage.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

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

TEST_CASE("what is held out takes no part in the fit") {
  DiagnoseOptions options;
  options.held_out = {"tank 2"};
  const Parallel parallel = serially();
  const EstimationSetup setup = hold_out_recordings(toys::bind_tank, toys::noisy_tanks({}, 0.01), {options, parallel});
  CHECK(setup.split.held_out == std::vector<std::size_t>{2});
  CHECK(setup.problem.recordings == std::vector<std::size_t>{0, 1, 3, 4, 5});
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

}  // namespace
}  // namespace surefoot::diagnosis
