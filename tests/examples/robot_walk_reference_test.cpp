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
constexpr const char* golden =
    "case,step_m,lateral_m,turn_rad,enabled_gain,support_phase_ratio,trunk_roll_rad,swing_pause,"
    "swing_roll_gain_rad,phase,left_hip_yaw_rad,left_hip_pitch_rad,left_hip_roll_rad,left_knee_rad,"
    "left_ankle_pitch_rad,left_ankle_roll_rad,right_hip_yaw_rad,right_hip_pitch_rad,right_hip_roll_rad,"
    "right_knee_rad,right_ankle_pitch_rad,right_ankle_roll_rad,reachable\n"
    "in_place,0,0,0,1,0,0,0,0,0,0.021029922562202926,-0.49397974584279269,0.13824859793366354,"
    "0.84982248100989688,-0.5072987869682376,-0.13982886403985176,-0.021029922562202926,-0.49397974584279269,"
    "-0.13824859793366354,0.84982248100989688,-0.5072987869682376,0.13982886403985176,1\n"
    "forward,0.02,0,0,1,0,0,0,0,0.26000000000000001,0.0048796226820181695,-0.51007301853832754,"
    "0.032275130360189558,0.88839917200799112,-0.52840490569132048,-0.032641790529175554,-0.04624338781772061,"
    "-0.86315980662028569,-0.29682840918372605,1.4301988315142002,-0.72395424451474932,0.30030379676499053,1\n"
    "forward_max,0.04,0,0,1,0,0,0,0,0.85999999999999999,0.035297866110749872,-0.90659824168293957,"
    "0.22939289564246423,1.3023254615120781,-0.54979402347932271,-0.23204548442140135,-0.011609707241530856,"
    "-0.44406542590222764,-0.076664414114327312,0.85044074838294081,-0.55682057127186524,0.077536788197586512,1\n"
    "backward,-0.02,0,0,1,0,0,0,0,0.54000000000000004,0.024600285833194426,-0.6074268089176148,"
    "0.16133899502344545,0.99549603168283296,-0.54005813108563772,-0.16318757637824469,-0.018338740232952396,"
    "-0.43795204828975942,-0.1207429448343471,0.83244119330355915,-0.54559765974730434,0.12212097345538314,1\n"
    "left,0,0.02,0,1,0,0,0,0,0.16,0.021702672066997188,-0.4926547066858239,0.14261169599804316,"
    "0.84704885886603343,-0.50594436831132905,-0.1442425188735425,-0.04405011218406165,-0.72745029704295538,"
    "-0.28351823489895134,1.3015574471016429,-0.73039481924344096,0.28682873413483362,1\n"
    "right,0,-0.02,0,1,0,0,0,0,0.66000000000000003,0.04405011218406165,-0.72745029704295538,0.28351823489895134,"
    "1.3015574471016429,-0.73039481924344096,-0.28682873413483362,-0.021702672066997178,-0.4926547066858239,"
    "-0.14261169599804308,0.84704885886603343,-0.50594436831132905,0.1442425188735425,1\n"
    "turn_left,0,0,0.2,1,0,0,0,0,0.41999999999999998,-0.17211416261377943,-0.48305238358040842,"
    "0.1088853478762464,0.86868806801250065,-0.53390611628711326,-0.082100217606985007,-0.042404591602511837,"
    "-0.6326908393050843,-0.18655067561559763,1.1151253505550613,-0.63508908924349416,0.19076792443730073,1\n"
    "turn_right,0,0,-0.1,1,0,0,0,0,0.93999999999999995,0.030546642280951747,-0.59725413126965454,"
    "0.17373064063145244,1.0495373826526744,-0.6045922911598397,-0.1763246829668785,0.079679069463242075,"
    "-0.49001982533981953,-0.11535441125616497,0.86451727600586636,-0.524807688859253,0.10216852396449433,1\n"
    "double_support,0.02,0.01,-0.1,1,0.2,0,0,0,0.57999999999999996,0.12766498814458443,-0.43082976797853156,"
    "0.17466740214479329,0.79113586689933468,-0.51187471775035887,-0.1917386615072906,-0.016768758678478265,"
    "-0.55050277727341013,-0.11049493712298358,0.8810233501578888,-0.48144796974651149,0.11175498680807838,1\n"
    "trunk_roll,0.02,0,0,1,0,0.05,0,0,0.10000000000000001,0.0067529670409780347,-0.54128307658003583,"
    "0.044651586166639376,0.87913214675632334,-0.48799986114810356,-0.095159012389702549,-0.03972798993646226,"
    "-0.69430981402255088,-0.25698404960265742,1.2480941219267438,-0.70891798187925292,0.20996963867111798,1\n"
    "swing_pause,0.02,0,0.1,1,0.1,0,0.1,0,0.76000000000000001,-0.0080634708428461103,-0.82440130523016852,"
    "0.3051635883238068,1.4206176116735558,-0.75330164379951736,-0.30042498564956732,-0.049427058217749467,"
    "-0.51813265835775091,-0.025886736673058935,0.89142359722310349,-0.52318849315686788,0.032979982584508856,1\n"
    "disabled,0.02,0,0,0,0,0,0,0,0.34000000000000002,0.021029922562202926,-0.49397974584279269,"
    "0.13824859793366354,0.84982248100989688,-0.5072987869682376,-0.13982886403985176,-0.021029922562202926,"
    "-0.49397974584279269,-0.13824859793366354,0.84982248100989688,-0.5072987869682376,0.13982886403985176,1\n";

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
  CHECK(complaint(std::string(golden).substr(0, std::string(golden).find('\n') + 1)).find("no row") !=
        std::string::npos);
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
