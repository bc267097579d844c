// The formats of recordings that surefoot-calibrate reads, and what it says about those it cannot.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "apps/calibrate/load_sequences.hpp"

using namespace calibrate_program;

namespace {

LoadedSequences loaded_from(const std::string& csv, const LoadOptions& options = {}) {
  return sequences_of(diagnose_program::parse_csv(csv, "walk.csv"), options);
}

LoadOptions wheels() {
  LoadOptions options;
  options.columns.wheels = {"v_left_m_s", "v_right_m_s"};
  options.wheel_base = 0.2;
  return options;
}

void check_walks_refused(const std::string& csv, const std::string& words, const LoadOptions& options = {}) {
  CAPTURE(csv);
  CAPTURE(words);
  try {
    loaded_from(csv, options);
    FAIL("not refused");
  } catch (const surefoot::Error& error) {
    const std::string what = error.what();
    CAPTURE(what);
    CHECK(what.find("walk.csv") == 0);
    CHECK(what.find(words) != std::string::npos);
    CHECK(what.find('\n') == std::string::npos);
  }
}

const std::string many =
    "# steps_per_cycle: 2\nseq,cycle,order_dx_m,order_dy_m,order_dtheta_rad,x_m,y_m,theta_rad\n"
    "3,0,0.01,0.02,0.1,,,\n3,1,0.02,0,0,1,2,0.5\n5,0,0.03,0,0,nan,nan,\n7,0,0.04,0,-0.1,0.1,0.2,\n";

std::string replaced(std::string text, const std::string& what, const std::string& instead) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), instead);
}

}  // namespace

TEST_CASE("many sequences in one file: commands times steps per cycle, poses at the end of their cycle") {
  const LoadedSequences loaded = loaded_from(many);
  REQUIRE(loaded.sequences.size() == 2);
  CHECK(loaded.sequences[0].name == "3 of walk.csv");
  CHECK(loaded.sequences[0].commands(0, 0) == 0.02);
  CHECK(loaded.sequences[0].commands(2, 0) == 0.2);
  CHECK(std::isnan(loaded.sequences[0].poses(0, 0)));
  CHECK(loaded.sequences[0].poses.col(1) == surefoot::Vec<3>(1, 2, 0.5));
  CHECK(loaded.sequences[1].name == "7 of walk.csv");
  CHECK(!loaded.sequences[1].heading_measured(0));
  CHECK(loaded.layout.many);
}

TEST_CASE("a sequence without a final position is left out, with a warning that counts") {
  const LoadedSequences loaded = loaded_from(many);
  REQUIRE(loaded.skipped.size() == 1);
  CHECK(skipped_sentence(loaded) == "1 of 3 sequences have no final position and are left out: 5 of walk.csv");
}

TEST_CASE("the option of steps per cycle goes before the first line of the file") {
  LoadOptions options;
  options.steps_per_cycle = 1;
  CHECK(loaded_from(many, options).sequences[0].commands(0, 0) == 0.01);
}

TEST_CASE("with final poses only the others are forgotten") {
  LoadOptions options;
  options.final_only = true;
  const auto loaded = loaded_from("seq,dx_m,dy_m,turn_rad,x_m,y_m\n1,0,0,0,1,1\n1,0,0,0,2,2\n", options);
  CHECK(!loaded.sequences[0].position_measured(0));
  CHECK(loaded.sequences[0].position_measured(1));
}

TEST_CASE(
    "one sequence per file: commands lead to the next row, poses are seen from the first, other units are converted") {
  const LoadedSequences loaded = loaded_from(
      "dx_cm,dy_cm,turn_deg,x_m,y_cm,yaw_deg\n10,0,90,1,100,90\n20,5,0,,,\n,,,1,150,180\n"
      "\n");
  REQUIRE(loaded.sequences.size() == 1);
  const surefoot::WalkSequence& sequence = loaded.sequences[0];
  CHECK(sequence.name == "walk.csv");
  REQUIRE(sequence.cycles() == 2);
  CHECK(sequence.commands(0, 1) == doctest::Approx(0.2));
  CHECK(sequence.commands(2, 0) == doctest::Approx(std::numbers::pi / 2));
  CHECK(sequence.poses(0, 1) == doctest::Approx(0.5));  // half a metre along y is straight ahead
  CHECK(sequence.poses(1, 1) == doctest::Approx(0).epsilon(1e-9));
  CHECK(sequence.poses(2, 1) == doctest::Approx(std::numbers::pi / 2));
  CHECK(!sequence.heading_measured(0));
  CHECK(loaded.layout.measured_start);
}

TEST_CASE("a recording whose first pose is empty starts at the origin") {
  const LoadedSequences loaded = loaded_from("dx_m,dy_m,turn_rad,x_m,y_m\n1,0,0,,\n1,0,0,3,4\n");
  CHECK(loaded.sequences[0].poses(1, 0) == 4);
  CHECK(!loaded.layout.measured_start);
}

TEST_CASE("columns may be named by the user") {
  LoadOptions options;
  options.columns.commands = {"a_m", "b_m", "c_deg"};
  options.columns.pose = {"px_m", "py_m"};
  const LoadedSequences loaded = loaded_from("seq,a_m,b_m,c_deg,px_m,py_m\n1,1,2,180,3,4\n", options);
  CHECK(loaded.sequences[0].commands(2, 0) == doctest::Approx(std::numbers::pi));
  CHECK(loaded.sequences[0].poses(0, 0) == 3);
}

TEST_CASE("speeds of wheels make commands, each held until the next row") {
  const auto loaded = loaded_from(
      "t_s,v_left_m_s,v_right_m_s,x_m,y_m,yaw_rad\n0,0.1,0.3,0,0,0\n0.5,0.2,0.2,,,\n1.5,,,1,1,0\n", wheels());
  const surefoot::WalkSequence& sequence = loaded.sequences[0];
  REQUIRE(sequence.cycles() == 2);
  CHECK(sequence.commands(0, 0) == doctest::Approx(0.1));
  CHECK(sequence.commands(1, 0) == 0);
  CHECK(sequence.commands(2, 0) == doctest::Approx(0.5));
  CHECK(sequence.commands(0, 1) == doctest::Approx(0.2));
  CHECK(loaded.layout.period == doctest::Approx(0.75));
}

TEST_CASE("what cannot be read is refused in one sentence that names the place") {
  const std::string head = "seq,cycle,dx_m,dy_m,turn_rad,x_m,y_m,theta_rad\n";
  check_walks_refused("", "the file is empty");
  check_walks_refused(head, "only 0 row(s)");
  check_walks_refused("dx_m,dy_m,turn_rad,x_m,y_m\n1,0,0,1,1\n", "at least 2");
  check_walks_refused("1,2,3\n4,5,6\n", "line 1: there is no header row");
  check_walks_refused(head + "1,0,0,0\n", "line 2: the row has 4 cells");
  check_walks_refused(head + "1,0,nan,0,0,1,1,0\n", "line 2: column 'dx_m' is empty; every cycle needs its command");
  check_walks_refused(head + "1,0,one,0,0,1,1,0\n", "line 2: column 'dx_m' holds \"one\"");
  check_walks_refused(head + "1,0,1e9,0,0,1,1,0\n", "line 2: a command of more than");
  check_walks_refused(head + "1,0,0,0,0,1e9,1,0\n", "line 2: column 'x_m' holds more than");
  check_walks_refused(head + "1,1,0,0,0,1,1,0\n1,1,0,0,0,1,1,0\n", "line 3: cycle 1 follows cycle 1");
  check_walks_refused(head + "1,1,0,0,0,1,1,0\n1,3,0,0,0,1,1,0\n", "line 3: cycle 3 follows cycle 1");
  check_walks_refused(head + "1,,0,0,0,1,1,0\n", "line 2: column 'cycle' is empty");
  check_walks_refused(head + ",0,0,0,0,1,1,0\n", "line 2: column 'seq' is empty");
  check_walks_refused(head + "1,0,0,0,0,1,1,0\n2,0,0,0,0,1,1,0\n1,1,0,0,0,1,1,0\n",
                      "line 4: sequence 1 was already over");
  check_walks_refused("seq,dx,dy_m,turn_rad,x_m,y_m\n1,0,0,0,1,1\n",
                      "column 'dx' (the command forward) does not end in a unit");
  check_walks_refused("seq,dx_m,dy_m,turn_rad,x,y_m\n1,0,0,0,1,1\n",
                      "column 'x' (the position forward) does not end in a unit");
  check_walks_refused("seq,speed_m,dy_m,turn_rad,x_m,y_m\n1,0,0,0,1,1\n",
                      "no column was recognised as the command forward");
  check_walks_refused("seq,dx_m,dy_m,turn_rad,x_m\n1,0,0,0,1\n",
                      "no column was recognised as the position to the left");
  check_walks_refused("dx_m,dy_m,turn_rad,x_m,y_m,theta_rad\n1,0,0,1,1,\n1,0,0,1,1,0\n",
                      "line 2: the first row holds part of a pose");
  check_walks_refused(replaced(many, "cycle: 2", "cycle: two"), "'steps_per_cycle: two' must give a number");
  check_walks_refused(replaced(many, "cycle: 2", "cycle: -1"), "must give a number");
  LoadOptions named;
  named.columns.commands = {"ordr_dx_m", "order_dy_m", "order_dtheta_rad"};
  check_walks_refused(many, "did you mean 'order_dx_m'?", named);
}

TEST_CASE("wheels without time, without speeds or with time that stands still are refused") {
  check_walks_refused("v_left_m_s,v_right_m_s,x_m,y_m\n0,0,0,0\n0,0,1,1\n", "column 't_s' is missing", wheels());
  check_walks_refused("t_s,v_right_m_s,x_m,y_m\n0,0,0,0\n1,0,1,1\n", "column 'v_left_m_s' is missing", wheels());
  check_walks_refused("t_s,v_left_m_s,v_right_m_s,x_m,y_m\n0,0,0,,\n0,0,0,1,1\n", "line 3: column 't_s' does not rise",
                      wheels());
  LoadOptions other = wheels();
  other.columns.wheels = {"left", "right"};
  check_walks_refused("t_s,left,right,x_m,y_m\n0,0,0,,\n1,0,0,1,1\n",
                      "column 'left' (the speed of a wheel) must end in", other);
}
