// motion.json: what is written is read again, and what is wrong is refused.
#include <doctest/doctest.h>

#include <string>

#include "tests/apps/calibrate_walks.hpp"

using namespace calibrate_program;

namespace {

void check_motion_file_refused(const std::string& from, const std::string& to, const std::string& words) {
  std::string text = motion_file_text(calibrate_test::rich_file());
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
  CAPTURE(words);
  try {
    parse_motion_file(text, "motion.json");
    FAIL("not refused");
  } catch (const surefoot::MotionError& error) {
    const std::string what = error.what();
    CAPTURE(what);
    CHECK(what.find("motion.json: ") == 0);
    CHECK(what.find(words) != std::string::npos);
    CHECK(what.find('\n') == std::string::npos);
  }
}

}  // namespace

TEST_CASE("a motion file is read as it was written") {
  const MotionFile file = calibrate_test::rich_file();
  const std::string text = motion_file_text(file);
  const MotionFile again = parse_motion_file(text, "motion.json");
  CHECK(motion_file_text(again) == text);
  CHECK(again.kind == ModelKind::full);
  CHECK(again.parameters == file.parameters);
  CHECK(again.model.parameters() == file.model.parameters());
  CHECK(again.covariance == file.covariance);
  CHECK(again.noise.per_speed == file.noise.per_speed);
  CHECK(again.noise.shape == surefoot::NoiseShape::uniform);
  CHECK(again.accuracy.heading_tolerance == 0.25);
  CHECK(again.steps_per_cycle == 2);
  CHECK(again.heldout[1].chosen);
  CHECK(std::isnan(again.heldout[1].heading));
  CHECK(again.test[0].position == 0.27);
}

TEST_CASE("every model is written and read, and moves as before") {
  for (const ModelKind kind : all_models) {
    MotionFile file = calibrate_test::rich_file();
    file.kind = kind;
    const surefoot::AnyMotionModel start = default_model(kind);
    const surefoot::AnyMotionModel model =
        start.with_parameters(0.9 * start.parameters() + 0.01 * start.parameter_box().width());
    file.parameters = model.parameters();
    file.covariance = 0.01 * Eigen::MatrixXd::Identity(start.parameter_count(), start.parameter_count());
    const MotionFile again = parse_motion_file(motion_file_text(file), "motion.json");
    CHECK(again.kind == kind);
    const Eigen::Matrix3Xd command = surefoot::Vec<3>(0.05, -0.02, 0.1);
    const surefoot::Vec<3> previous(0.01, 0.02, 0.3);
    CHECK(again.model.displacement(command.col(0), previous)
              .vec()
              .isApprox(model.displacements(command, previous).col(0), 1e-12));
  }
}

TEST_CASE("a motion file that is wrong is refused in one sentence that names the field") {
  check_motion_file_refused("{", "", "this is not JSON");
  check_motion_file_refused("motion/1", "motion/2", "\"schema\": only");
  check_motion_file_refused("\"full\"", "\"cubic\"", "\"model\": \"proportional\"");
  check_motion_file_refused("\"full\"", "\"simple\"", "a list of the 6 coefficients");
  check_motion_file_refused("dx per dx", "dx per dy", "\"parameters[1]\": the coefficient \"dx per dx\"");
  check_motion_file_refused("1.3,", "1e3,", "\"parameters[1].value\": a number from 0");
  check_motion_file_refused("1.3,", "null,", "\"parameters[1].value\"");
  check_motion_file_refused("\"uniform\"", "\"round\"", "\"noise.shape\"");
  check_motion_file_refused("\"scale\"", "\"sale\"", "\"noise.scale\": is missing");
  check_motion_file_refused("\"sequences\": 25", "\"sequences\": -1", "\"sequences\": a whole number");
  check_motion_file_refused("0.0001", "-0.0001", "\"covariance\": is not symmetric and positive definite");
  check_motion_file_refused("\"steps_per_cycle\": 2.0", "\"steps_per_cycle\": 0", "\"steps_per_cycle\": a number from");
}
