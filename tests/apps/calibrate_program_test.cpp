// surefoot-calibrate as a whole.
#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "apps/calibrate/load_sequences.hpp"
#include "apps/diagnose/equations.hpp"
#include "apps/diagnose/load_recording.hpp"
#include "tests/apps/calibrate_walks.hpp"

using approach_program::Outcome;
using approach_program::ScratchFolder;
using approach_program::write_text;
using calibrate_test::calibrate;
using namespace calibrate_program;

namespace {

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

bool contains(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

/// The sheet as somebody fills it in who watches the robot of the paper; two sequences fell.
std::string filled_in(const std::vector<surefoot::WalkSequence>& walks) {
  std::ostringstream sheet;
  sheet << "seq,x_cm,y_cm,heading_clock\n";
  for (std::size_t i = 0; i < walks.size(); ++i) {
    const auto pose = walks[i].poses.rightCols<1>();
    const double hour = std::round(-pose(2) / (std::numbers::pi / 6));
    sheet << i + 1 << ',';
    if (i == 3 || i == 8) {
      sheet << ",,\n";
    } else {
      sheet << 100 * pose(0) << ',' << 100 * pose(1) << ',' << (hour <= 0 ? hour + 12 : hour) << '\n';
    }
  }
  return sheet.str();
}

/// The root mean square error of a simulator with the parameters of the model file, on the recordings it is for.
std::size_t check_model_file(const std::string& model, const std::string& csv) {
  const auto file = diagnose_program::read_model_file(model);
  return diagnose_program::load_recordings(csv, diagnose_program::layout_of(file)).recordings.size();
}

double chosen_test_error(const std::string& motion, int parameters) {
  for (const EvaluatedModel& model : read_motion_file(motion).test) {
    if (model.parameters == parameters) return model.position;
  }
  return NAN;
}

}  // namespace

TEST_CASE("plan, fill in, sheet, fit, update: from nothing to a model that is kept up to date") {
  const ScratchFolder folder;
  const Outcome plan = calibrate("plan --sequences 20 --cycles 12 --seed 5 --out " + folder.file("plan"));
  REQUIRE_MESSAGE(plan.code == 0, plan.output);
  CHECK(contains(plan.output, "m ahead of the start"));
  CHECK(contains(text_of(folder.file("plan/sheet.html")), "<td>20</td>"));
  LoadOptions commands;
  commands.poses_needed = false;
  auto walks = sequences_of(diagnose_program::read_csv(folder.file("plan/commands.csv")), commands).sequences;
  REQUIRE(walks.size() == 20);
  const MotionFile robot = paper_robot();
  for (std::size_t i = 0; i < walks.size(); ++i) {
    surefoot::Rng rng(1, i);
    walks[i] = simulate_walk(robot.model, robot.noise, {}, surefoot::planned_sequence(walks[i].commands, false), rng);
  }
  write_text(folder.file("sheet.csv"), filled_in(walks));
  const Outcome sheet = calibrate("sheet --commands " + folder.file("plan/commands.csv") + " --sheet " +
                                  folder.file("sheet.csv") + " --out " + folder.file("walks.csv"));
  REQUIRE_MESSAGE(sheet.code == 0, sheet.output);
  CHECK(contains(sheet.output, "2 of 20 sequences have no position"));

  const Outcome fit = calibrate("fit --model simple --out " + folder.file("fit") + " " + folder.file("walks.csv"));
  REQUIRE_MESSAGE(fit.code == 0, fit.output);
  CHECK(contains(fit.output, "18 sequences"));
  CHECK(contains(fit.output, "whole hours of a clock"));
  const MotionFile fitted = read_motion_file(folder.file("fit/motion.json"));
  CHECK(fitted.kind == ModelKind::simple);
  CHECK(fitted.method == "likelihood");
  CHECK(fitted.parameters[1] == doctest::Approx(1.3).epsilon(0.25));
  CHECK(fitted.heldout[2].position < 0.8 * fitted.heldout[0].position);
  CHECK(check_model_file(folder.file("fit/motion.toml"), folder.file("walks.csv")) == 18);
  CHECK(text_of(folder.file("fit/final_poses.svg")).find("<svg") != std::string::npos);

  const Outcome update = calibrate("update --alarm-threshold 8 --motion " + folder.file("fit/motion.json") + " --out " +
                                   folder.file("later") + " " + folder.file("walks.csv"));
  REQUIRE_MESSAGE(update.code == 0, update.output);
  CHECK(!contains(update.output, "ALARM"));
  const MotionFile updated = read_motion_file(folder.file("later/motion.json"));
  CHECK(updated.sequences == 36);
  CHECK(updated.covariance.trace() < fitted.covariance.trace());
}

TEST_CASE("one file per sequence is fitted and gives a model file for surefoot-diagnose") {
  const ScratchFolder folder;
  const auto walks = calibrate_test::paper_walks(8, 10, true);
  std::string files;
  for (std::size_t i = 0; i < walks.size(); ++i) {
    std::ostringstream csv;
    csv << "dx_m,dy_m,turn_rad,x_m,y_m,yaw_rad\n";
    for (Eigen::Index row = 0; row <= walks[i].cycles(); ++row) {
      if (row < walks[i].cycles()) {
        csv << walks[i].commands(0, row) << ',' << walks[i].commands(1, row) << ',' << walks[i].commands(2, row);
      } else {
        csv << ",,";
      }
      const surefoot::Pose2 start{1, 2, 0.7};
      const auto pose = row == 0 ? start : start * surefoot::Pose2::from_vec(walks[i].poses.col(row - 1));
      csv << ',' << pose.x << ',' << pose.y << ',' << pose.angle << '\n';
    }
    write_text(folder.file("w" + std::to_string(i) + ".csv"), csv.str());
    files += " " + folder.file("w" + std::to_string(i) + ".csv");
  }
  const Outcome fit = calibrate("fit --model previous-command --out " + folder.file("fit") + files);
  REQUIRE_MESSAGE(fit.code == 0, fit.output);
  CHECK(read_motion_file(folder.file("fit/motion.json")).method == "likelihood");
  CHECK(check_model_file(folder.file("fit/motion.toml"), folder.file("w0.csv")) == 1);
}

TEST_CASE("a robot whose leg bends raises the alarm") {
  const ScratchFolder folder;
  MotionFile robot = paper_robot();
  robot.covariance *= 1e6;
  robot.sequences = 50;
  robot.readings = 5000;
  write_motion_file(folder.file("motion.json"), robot);
  REQUIRE(calibrate("simulate --sequences 5 --seed 3 --out " + folder.file("before.csv")).code == 0);
  robot.parameters[1] *= 0.7;
  robot.model = embedded(robot.kind, robot.parameters);
  write_motion_file(folder.file("bent.json"), robot);
  REQUIRE(calibrate("simulate --sequences 10 --seed 4 --motion " + folder.file("bent.json") + " --out " +
                    folder.file("after.csv"))
              .code == 0);
  const Outcome update =
      calibrate("update --alarm-threshold 12 --motion " + folder.file("motion.json") + " --out " + folder.file("new") +
                " " + folder.file("before.csv") + " " + folder.file("after.csv"));
  REQUIRE_MESSAGE(update.code == 0, update.output);
  CAPTURE(update.output);
  CHECK(contains(update.output, "ALARM: the robot no longer walks as calibrated. dx per dx changed by -0."));
  CHECK(read_motion_file(folder.file("new/motion.json")).parameters[1] == doctest::Approx(0.91).epsilon(0.1));
}

TEST_CASE("wrong readings are named, and kept") {
  auto walks = calibrate_test::paper_walks(25, 12, false);
  walks[6].poses(0, 11) += 3;
  FitSettings settings;
  settings.kind = ModelKind::proportional;
  const FittedWalk fitted = fit_walk(walks, {}, settings, calibrate_test::two_threads());
  REQUIRE(fitted.outliers.size() == 1);
  CAPTURE(fitted.outliers[0]);
  CHECK(contains(fitted.outliers[0], "sequence 7 ends "));
  CHECK(contains(fitted.outliers[0], "a wrong reading? It was kept"));
  CHECK(fitted.file.sequences == 25);
}

TEST_CASE("a learning curve is written and says what to do") {
  const ScratchFolder folder;
  REQUIRE(calibrate("simulate --sequences 14 --cycles 8 --final-only --out " + folder.file("walks.csv")).code == 0);
  const Outcome curve =
      calibrate("curve --repetitions 6 --counts 3,9 --out " + folder.file("curve") + " " + folder.file("walks.csv"));
  REQUIRE_MESSAGE(curve.code == 0, curve.output);
  CHECK(contains(curve.output, "With these 14 sequences use the model "));
  CHECK(contains(text_of(folder.file("curve/curve.csv")), "full,9,"));
  CHECK(std::filesystem::exists(folder.file("curve/coefficients.png")));

  const std::string splits = text_of(folder.file("curve/splits_full.csv")),
                    csv = text_of(folder.file("curve/curve.csv"));
  std::ofstream(folder.file("curve/splits_full.csv")) << splits.substr(0, splits.size() / 2);  // killed while it wrote
  const Outcome again =
      calibrate("curve --repetitions 6 --counts 3,9 --out " + folder.file("curve") + " " + folder.file("walks.csv"));
  REQUIRE_MESSAGE(again.code == 0, again.output);
  CHECK(text_of(folder.file("curve/curve.csv")) == csv);
  CHECK(text_of(folder.file("curve/splits_full.csv")).size() == splits.size());
}

TEST_CASE("wrong options and files end with 2 and one sentence") {
  const ScratchFolder folder;
  write_text(folder.file("one.csv"), "seq,dx_m,dy_m,turn_rad,x_m,y_m\n1,0,0,0,1,1\n");
  write_text(folder.file("none.csv"), "seq,dx_m,dy_m,turn_rad,x_m,y_m\n1,0,0,0,,\n");
  write_text(folder.file("two.csv"), "# steps_per_cycle: 2\nseq,dx_m,dy_m,turn_rad,x_m,y_m\n1,0,0,0,1,1\n");
  const std::string out = " --out " + folder.file("out") + " ";
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const Outcome outcome = calibrate(arguments);
    CAPTURE(arguments);
    CAPTURE(outcome.output);
    CHECK(outcome.code == 2);
    CHECK(contains(outcome.output, words));
  };
  refused("", "subcommand is required");
  refused("fit", "required");
  refused("fit" + out + folder.file("not_there.csv"), "cannot be opened");
  refused("fit" + out + folder.file("one.csv"), "only 1 sequence has a final position");
  refused("fit" + out + folder.file("none.csv"), "no sequence has a final position");
  refused("fit" + out + folder.file("one.csv") + " " + folder.file("two.csv"),
          "has 2 steps per cycle, but one.csv has 1");
  refused("fit --wheels a_m_s,b_m_s" + out + folder.file("one.csv"), "--wheels needs --wheel-base");
  refused("fit --model cubic" + out + folder.file("one.csv"), "--model");
  refused("curve" + out + folder.file("one.csv"), "only 1 sequence has a final position");
  refused("update --motion " + folder.file("one.csv") + out + folder.file("one.csv"), "this is not JSON");
  refused("plan --low 1,1,1" + out, "CommandBounds: low of dx");
  CHECK(!std::filesystem::exists(folder.file("out/motion.json")));
}

TEST_CASE("the walking twin is calibrated from final poses alone to what its recordings allow") {
  const char* recordings = std::getenv("SUREFOOT_RECORDINGS");
  if (recordings == nullptr || !std::filesystem::exists(std::string(recordings) + "/twin_walk/plain.csv")) {
    MESSAGE("skipped: SUREFOOT_RECORDINGS does not name a folder with twin_walk");
    return;
  }
  const ScratchFolder folder;
  const std::string twin = std::string(recordings) + "/twin_walk/";
  const Outcome fit = calibrate("fit --final-only --steps-per-cycle 2 --test " + twin + "plain.csv --out " +
                                folder.file("fit") + " " + twin + "plain_more.csv");
  REQUIRE_MESSAGE(fit.code == 0, fit.output);
  CAPTURE(fit.output);
  CHECK(chosen_test_error(folder.file("fit/motion.json"), 0) == doctest::Approx(0.402).epsilon(0.01));
  CHECK(chosen_test_error(folder.file("fit/motion.json"), 12) <= 0.115);
  CHECK(chosen_test_error(folder.file("fit/motion.json"), 21) <= 0.095);
}
