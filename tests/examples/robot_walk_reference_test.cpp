#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "examples/sigmaban/robot/walk_engine/compare_with_reference.hpp"
#include "examples/sigmaban/robot/walk_engine/reference_file.hpp"
#include "examples/sigmaban/robot/walk_engine/spline_walk.hpp"
#include "tests/support/program.hpp"

using namespace sigmaban;

namespace {

/// A row of every case of the published engine (Rhoban/IKWalk, commit f366bd9), printed with 17 digits.
std::string golden_rows() {
  std::ostringstream text;
  text << std::ifstream(SUREFOOT_SOURCE_DIR "/examples/sigmaban/robot/walk_engine/joint_targets.csv").rdbuf();
  return text.str();
}

const std::string golden = golden_rows();

SplineWalk our_engine(const WalkParameters& parameters, double phase) { return SplineWalk(parameters, phase); }

std::vector<ReferenceRow> rows_of(const std::string& text) {
  std::istringstream file(text);
  return read_reference(file);
}

/// What is wrong with a file; empty if nothing.
std::string complaint(const std::string& text) {
  try {
    rows_of(text);
    return "";
  } catch (const ReferenceError& error) {
    return error.what();
  }
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const auto at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), by);
}

/// The file of all cases, if somebody keeps one: in $SUREFOOT_REFERENCE/ikwalk, else beside the sources.
std::filesystem::path reference_file() {
  const char* folder = std::getenv("SUREFOOT_REFERENCE");
  const std::filesystem::path root =
      folder != nullptr ? std::filesystem::path(folder)
                        : std::filesystem::path(SUREFOOT_SOURCE_DIR).parent_path() / "shared" / "reference";
  return root / "ikwalk" / "joint_targets.csv";
}

const std::string engine_check = SUREFOOT_BIN_DIR "/walk_engine_check";

approach_program::Outcome check(const approach_program::ScratchFolder& folder, const std::string& text) {
  std::ofstream(folder.file("rows.csv")) << text;
  return approach_program::run_command(engine_check + " " + folder.file("rows.csv"));
}

}  // namespace

TEST_CASE("a row of every published case is met within 1e-9 rad") {
  const auto rows = rows_of(golden);
  const auto result = compare_with_reference(rows, our_engine);
  CHECK(rows.size() == 12);
  CHECK(result.reachable == 12);
  CHECK(result.disagreements == 0);
  CHECK(result.largest_error < 1e-11);
  CHECK(result.agrees());
}

TEST_CASE("every row of the published engine is met within 1e-9 rad, where the file is at hand") {
  const auto path = reference_file();
  if (!std::filesystem::exists(path)) {
    MESSAGE("skipped: there is no " << path.string());
    return;
  }
  std::ifstream file(path);
  const auto rows = read_reference(file);
  const auto result = compare_with_reference(rows, our_engine);
  MESSAGE(rows.size() << " rows, largest joint error " << result.largest_error << " rad");
  CHECK(rows.size() == 600);
  CHECK(result.agrees());
}

TEST_CASE("columns come in any order, with or without their unit, and override the defaults") {
  const std::string joints =
      "left_hip_yaw_rad,left_hip_pitch_rad,left_hip_roll_rad,left_knee_rad,left_ankle_pitch_rad,left_ankle_roll_rad,"
      "right_hip_yaw_rad,right_hip_pitch_rad,right_hip_roll_rad,right_knee_rad,right_ankle_pitch_rad,"
      "right_ankle_roll_rad";
  const auto rows = rows_of("reachable,freq_hz,trunk_pitch,rise_gain_m,swing_phase,extra_left_yaw_rad," + joints +
                            ",phase\r\n0,1.5,0.2,0.04,0.1,0.3,,,,,,,nan,nan,nan,nan,nan,nan,0.5\r\n\r\n");
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].line == 2);
  CHECK_FALSE(rows[0].reachable);
  CHECK(rows[0].phase == 0.5);
  const WalkParameters& p = rows[0].settings.parameters;
  CHECK(p.frequency == 1.5);
  CHECK(p.trunk_pitch == 0.2);
  CHECK(p.rise == 0.04);
  CHECK(p.swing_phase == 0.1);
  CHECK(p.extra_left.yaw == 0.3);
  CHECK(p.foot_y_offset == 0.025);
}

TEST_CASE("a file that is no reference is refused with its line and column") {
  CHECK(complaint(golden).empty());
  CHECK(complaint("").find("line 1") != std::string::npos);
  CHECK(complaint("phase\n0\n").find("'left_hip_yaw_rad' is missing") != std::string::npos);
  CHECK(complaint(replaced(golden, "step_m", "stride_m")).find("no column called 'stride_m'") != std::string::npos);
  CHECK(complaint(replaced(golden, "lateral_m", "step")).find("'step' is there twice") != std::string::npos);
  CHECK(complaint(replaced(golden, "forward,0.02", "forward,0.02x")).find("line 3, column step_m: '0.02x'") !=
        std::string::npos);
  CHECK(complaint(replaced(golden, "forward,0.02", "forward")).find("line 3: 22 cells where 23") != std::string::npos);
  CHECK(complaint(replaced(golden, "forward,0.02", "forward,nan")).find("not a finite number") != std::string::npos);
  CHECK(complaint(golden.substr(0, golden.find('\n') + 1)).find("no row") != std::string::npos);
}

TEST_CASE("the program says 0 for agreement, 1 for a difference and 2 for bad input") {
  if (!std::filesystem::exists(engine_check)) {
    MESSAGE("skipped: walk_engine_check is not built");
    return;
  }
  const approach_program::ScratchFolder folder;
  CHECK(check(folder, golden).code == 0);
  CHECK(check(folder, golden).output.find("12 rows, 12 with targets") != std::string::npos);

  const auto moved = check(folder, replaced(golden, "0.021029922562202926", "0.021029922062202926"));
  CHECK(moved.code == 0);  // 5e-10 rad
  const auto off = check(folder, replaced(golden, "0.021029922562202926", "0.021029932562202926"));
  CHECK(off.code == 1);  // 1e-8 rad
  CHECK(off.output.find("left_hip_yaw, line 2, case in_place") != std::string::npos);

  const auto reach = check(folder, replaced(golden, "forward,0.02", "forward,0.4"));
  CHECK(reach.code == 1);
  CHECK(reach.output.find("reachability differs in 1 rows, first in line 3") != std::string::npos);

  CHECK(check(folder, "what?\n").code == 2);
  CHECK(approach_program::run_command(engine_check).code == 2);
  CHECK(approach_program::run_command(engine_check + " " + folder.file("missing.csv")).code == 2);
}
