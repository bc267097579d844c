// Screening: what recordings are refused for, what is taken out of them, and what is said of them.
#include "surefoot/diagnose/screening.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot {
namespace {

using toys::LeakyTank;

const SimulatorInfo info = LeakyTank{}.info();

// A tank with noise of 2 mm and swings of half a metre.
Recording tank() {
  Recording recording = toys::tank_recording(1, 400);
  recording.outputs = simulate_augmented(LeakyTank{}, {}, recording).outputs;
  Rng rng(1);
  for (double& level : recording.outputs.reshaped()) level += 0.002 * rng.normal();
  return recording;
}

bool mentions(const std::vector<Remark>& remarks, const std::string& text) {
  return std::any_of(remarks.begin(), remarks.end(),
                     [&](const Remark& remark) { return remark.text.find(text) != std::string::npos; });
}

TEST_CASE("single outliers are taken out, those and no others, and named") {
  Recording recording = tank();
  const Eigen::MatrixXd clean = recording.outputs;
  for (const Eigen::Index row : {50, 51 + 70, 300}) recording.outputs(0, row) += row == 300 ? -3 : 2;
  const std::vector<Remark> remarks = remove_outliers(info, recording);
  CHECK(remarks.size() == 3);
  CHECK(mentions(remarks, "level_m at time 2.5 "));
  for (Eigen::Index row = 0; row < 400; ++row) {
    const bool outlier = row == 50 || row == 121 || row == 300;
    CHECK(std::isnan(recording.outputs(0, row)) == outlier);
    if (!outlier) CHECK(recording.outputs(0, row) == clean(0, row));
  }
}

TEST_CASE("an outlier may be small beside the signal: what counts is how it stands out, and what the sensor resolves") {
  Recording fine = tank();
  for (Eigen::Index i = 0; i < 400; ++i) fine.outputs(0, i) = std::sin(0.01 * static_cast<double>(i));
  fine.outputs(0, 160) += 0.008;  // of 1
  CHECK(remove_outliers(info, fine).size() == 1);
  CHECK(std::isnan(fine.outputs(0, 160)));
  Recording coarse = tank();  // a sensor at rest that flickers by its last digit
  coarse.outputs.setConstant(1);
  for (const Eigen::Index row : {40, 200, 300}) coarse.outputs(0, row) = 1.01;
  CHECK(remove_outliers(info, coarse).empty());
}

TEST_CASE("where readings move fast, the neighbour of an outlier is not taken for it") {
  Recording moving = tank();
  Eigen::MatrixXd simulated = moving.outputs;
  for (Eigen::Index i = 0; i < 400; ++i) {
    const auto row = static_cast<double>(i);
    simulated(0, i) = 3 * std::sin(0.02 * row);
    moving.outputs(0, i) = simulated(0, i) + 1e-3 * std::sin(1.7 * row);
  }
  moving.outputs(0, 160) += 0.12;  // falls by 0.06 a row there: the one before it bends by half as much the other way
  REQUIRE(remove_outliers(info, moving).empty());
  CHECK(remove_outliers(info, moving, simulated).size() == 1);
  CHECK(std::isnan(moving.outputs(0, 160)));
}

TEST_CASE("what a model says shows outliers among readings that move fast by themselves, and only those") {
  Recording lively = tank();
  Eigen::MatrixXd simulated = lively.outputs;
  Rng rng(2);
  for (Eigen::Index i = 0; i < 400; ++i) {
    simulated(0, i) = i % 7 < 3 ? 0.1 * static_cast<double>(i % 5) : -0.2;
    lively.outputs(0, i) = simulated(0, i) + 1e-3 * rng.normal();
  }
  CHECK(remove_outliers(info, lively, simulated).empty());
  lively.outputs(0, 200) += 0.05;
  CHECK(remove_outliers(info, lively).empty());
  CHECK(remove_outliers(info, lively, simulated).size() == 1);
  CHECK(std::isnan(lively.outputs(0, 200)));
}

TEST_CASE("a bend between two neighbours, as where friction stops a motion, is no outlier") {
  Recording stopped = tank();
  Eigen::MatrixXd simulated = stopped.outputs;
  Rng rng(3);
  for (Eigen::Index i = 0; i < 400; ++i) {
    simulated(0, i) = i < 200 ? 0.2 : i == 200 ? 0.025 : -0.15;
    stopped.outputs(0, i) = simulated(0, i) + 2e-4 * rng.normal();
  }
  stopped.outputs(0, 200) = 0.147;
  CHECK(remove_outliers(info, stopped, simulated).empty());
  stopped.outputs(0, 200) = 0.247;
  CHECK(remove_outliers(info, stopped, simulated).size() == 1);
}

TEST_CASE("where only the simulation jumps no reading is an outlier") {
  Recording smooth = tank();
  Eigen::MatrixXd simulated = smooth.outputs;
  for (Eigen::Index i = 0; i < 400; ++i)
    smooth.outputs(0, i) = simulated(0, i) = 0.3 * std::sin(0.1 * static_cast<double>(i));
  simulated(0, 200) += 0.5;
  CHECK(remove_outliers(info, smooth, simulated).empty());
  smooth.outputs(0, 100) += 0.5;
  CHECK(remove_outliers(info, smooth, simulated).size() == 1);
}

TEST_CASE("steps, slow swings, noise and short pulses of two rows are no outliers") {
  Recording plain = tank();
  CHECK(remove_outliers(info, plain).empty());
  Recording stepping = tank();
  stepping.outputs.rightCols(150).array() += 1;
  stepping.outputs.middleCols(60, 2).array() += 1;
  CHECK(remove_outliers(info, stepping).empty());
  CHECK(stepping.outputs.allFinite());
}

TEST_CASE("recordings in which no sensor ever moves are refused") {
  const auto refusal = [](const std::vector<Recording>& recordings) {
    try {
      check_readings(info, recordings);
    } catch (const DiagnoseError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  std::vector<Recording> two{tank(), tank()};
  two[0].outputs.setConstant(0.7);
  CHECK(refusal(two).empty());
  two[1].outputs.setConstant(0.5);  // as where only the end of each is measured
  CHECK(refusal(two).empty());
  two[1].outputs.setConstant(0.7);
  two[1].outputs(0, 3) = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal(two).find("no output changes in any recording: see that the sensors are connected") == 0);
}

TEST_CASE("recordings that do not fit are refused by name, channel and row") {
  const auto refusal = [](auto&& spoil) {
    Recording recording = tank();
    spoil(recording);
    try {
      check_recording(info, recording);
    } catch (const DiagnoseError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusal([](Recording&) {}).empty());
  CHECK(refusal([](Recording& r) { r.time[7] = r.time[6]; }) == "tank 1: time does not rise at row 7");
  CHECK(refusal([](Recording& r) { r.inputs(0, 9) = std::numeric_limits<double>::quiet_NaN(); }) ==
        "tank 1: input 'valve' has no value in row 9; inputs must be known throughout");
  CHECK(refusal([](Recording& r) { r.outputs.setConstant(std::numeric_limits<double>::quiet_NaN()); }) ==
        "tank 1: no output was ever measured");
  CHECK(refusal([](Recording& r) { r.outputs.conservativeResize(2, 400); }).find("outputs must have") !=
        std::string::npos);
  CHECK(refusal([](Recording& r) { r.inputs.conservativeResize(1, 399); }).find("inputs must have") !=
        std::string::npos);
  CHECK(refusal([](Recording& r) { r.initial.setZero(3); }).find("initial state") != std::string::npos);
  CHECK(refusal([](Recording& r) { r.time.conservativeResize(1); }).find("at least two rows") != std::string::npos);
}

TEST_CASE("what cannot be seen in the recordings is said, once the inputs of all are known") {
  Recording still = tank(), positive = tank(), negative = tank();
  still.inputs.setConstant(0.5);
  positive.inputs = positive.inputs.cwiseAbs();
  negative.inputs = -negative.inputs.cwiseAbs();
  CHECK(mentions(screen(info, {still, still}), "valve never changes:"));
  CHECK(mentions(screen(info, {still, positive}), "valve never changes its sign"));
  CHECK_FALSE(mentions(screen(info, {still, positive, negative}), "valve"));
  still.inputs(0, 3) = 0;  // a switch
  CHECK_FALSE(mentions(screen(info, {still}), "valve"));
}

TEST_CASE("where anything would fit nothing is diagnosed") {
  const auto of_rows = [](Eigen::Index rows, int count) {
    Recording one = tank();
    one.outputs = one.outputs.leftCols(rows).eval();
    return std::vector<Recording>(static_cast<std::size_t>(count), one);
  };
  CHECK_THROWS_WITH_AS(
      check_readings(info, of_rows(2, 1)),
      "the recordings hold 1 readings after their first rows, too few to tell 2 parameters and initial "
      "states; record at least 6",
      DiagnoseError);
  CHECK_NOTHROW(check_readings(info, of_rows(2, 6)));
  CHECK_NOTHROW(check_readings(info, of_rows(7, 1)));
}

TEST_CASE("sensors that stand still are named with their recording, machines that rest at times are not") {
  Recording frozen = tank(), resting = tank();
  frozen.outputs.setConstant(0.3);
  frozen.name = "frozen";
  const double ceiling = 0.5 * resting.outputs.maxCoeff();
  resting.outputs = resting.outputs.cwiseMin(ceiling);
  const std::vector<Remark> remarks = screen(info, {tank(), frozen, resting});
  CHECK(mentions(remarks, "level_m never changes"));
  REQUIRE(remarks.size() == 1);
  CHECK(remarks[0].recording == "frozen");
  CHECK(screen(info, {tank()}).empty());
}

}  // namespace
}  // namespace surefoot
