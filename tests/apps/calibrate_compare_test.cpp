// surefoot-calibrate compare as a whole.
#include <doctest/doctest.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/apps/calibrate_walks.hpp"

using approach_program::Outcome;
using approach_program::ScratchFolder;
using approach_program::write_text;
using calibrate_test::calibrate;

namespace {

nlohmann::json compared(const ScratchFolder& folder, const std::string& arguments) {
  const Outcome outcome = calibrate("compare --out " + folder.file("out") + " " + arguments);
  REQUIRE_MESSAGE(outcome.code == 0, outcome.output);
  std::ifstream file(folder.file("out/compare.json"));
  return nlohmann::json::parse(file);
}

/// Walks of the robot of the paper whose coefficient `changed` is larger by `by`.
std::string walks_csv_of(Eigen::Index changed, double by, int count, std::uint64_t seed) {
  calibrate_program::MotionFile robot = calibrate_program::paper_robot();
  Eigen::VectorXd parameters = robot.model.parameters();
  parameters[changed] += by;
  const auto model = surefoot::PreviousCommandCorrection::from_parameters(surefoot::Vec<21>(parameters));
  std::vector<surefoot::WalkSequence> walks;
  for (const auto& commands : surefoot::plan_commands(surefoot::CommandBounds(), count, 25, seed)) {
    surefoot::Rng rng(seed, walks.size(), 7);
    walks.push_back(simulate_walk(model, robot.noise, {}, surefoot::planned_sequence(commands, true), rng));
  }
  return calibrate_program::walks_csv(walks, 1);
}

}  // namespace

TEST_CASE("compare names what changed since old recordings, and since an old calibration") {
  const ScratchFolder folder;
  write_text(folder.file("old.csv"), walks_csv_of(0, 0, 25, 1));
  write_text(folder.file("same.csv"), walks_csv_of(0, 0, 10, 2));
  write_text(folder.file("new.csv"), walks_csv_of(4, 0.015, 10, 3));  // dy offset
  const auto same = compared(folder, folder.file("old.csv") + " " + folder.file("same.csv"));
  CHECK(same["schema"] == "surefoot.compare/1");
  CHECK(same["changed"] == false);
  const auto now = compared(folder, "--old " + folder.file("old.csv") + " --new " + folder.file("new.csv"));
  CHECK(now["changed"] == true);
  REQUIRE(now["found"].size() == 1);
  CHECK(now["found"][0]["any_of"][0]["change"] == "dy offset");
  CHECK(now["found"][0]["sentence"].get<std::string>().find("drifts to the left") != std::string::npos);
  CHECK(now["coefficients"][4]["changed"] == true);
  CHECK(now["coefficients"][4]["low"] < 0.015);
  CHECK(now["coefficients"][4]["high"] > 0.015);

  const Outcome fit = calibrate("fit --model full --out " + folder.file("fit") + " " + folder.file("old.csv"));
  REQUIRE_MESSAGE(fit.code == 0, fit.output);
  const auto since = compared(folder, folder.file("fit/motion.json") + " " + folder.file("new.csv"));
  CHECK(since["found"][0]["any_of"][0]["change"] == "dy offset");
  CHECK(compared(folder, folder.file("fit/motion.json") + " " + folder.file("same.csv"))["changed"] == false);
}

TEST_CASE("compare says what can cause a change, and does not call a likely one nothing") {
  const ScratchFolder folder;
  write_text(folder.file("old.csv"), walks_csv_of(0, 0, 25, 1));
  write_text(folder.file("new.csv"), walks_csv_of(4, 0.015, 10, 3));  // dy offset
  const Outcome drift = calibrate("compare " + folder.file("old.csv") + " " + folder.file("new.csv"));
  CHECK(drift.output.find("A drift: the zero of a joint, legs of different length") != std::string::npos);
  CHECK(drift.output.find("--new-joints") != std::string::npos);

  // Six of ten fell, where one of ten did: likely more, but not certain.
  const auto with_falls = [](std::string csv, int falls) {
    std::string text;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
      int sequence = 0, cycle = 0;
      const bool row = std::sscanf(line.c_str(), "%d,%d", &sequence, &cycle) == 2;
      if (!row || sequence > falls || cycle < 12) text += line + "\n";
    }
    return text;
  };
  write_text(folder.file("some.csv"), with_falls(walks_csv_of(0, 0, 12, 1), 0));
  write_text(folder.file("more.csv"), with_falls(walks_csv_of(0, 0, 12, 2), 5));
  const Outcome likely = calibrate("compare " + folder.file("some.csv") + " " + folder.file("more.csv"));
  REQUIRE_MESSAGE(likely.code == 0, likely.output);
  CAPTURE(likely.output);
  CHECK(likely.output.find("too little for a statement") != std::string::npos);
  CHECK(likely.output.find("The likeliest: the robot falls more often: 5 of 12") != std::string::npos);

  write_text(folder.file("most.csv"), with_falls(walks_csv_of(0, 0, 12, 2), 10));
  const auto fell = compared(folder, folder.file("some.csv") + " " + folder.file("most.csv"));
  CHECK(fell["falls"]["new"] == 10);
}

TEST_CASE("compare says what it needs") {
  const Outcome one = calibrate("compare old.csv");
  CHECK(one.code != 0);
  CHECK(one.output.find("compare needs OLD and NEW") != std::string::npos);
}
