// CSV files as recordings of a model, and the recordings of others where they are at hand.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/diagnose/equations.hpp"
#include "apps/diagnose/load_all.hpp"
#include "apps/diagnose/load_recording.hpp"
#include "tests/apps/diagnose_models.hpp"

using namespace diagnose_program;
using diagnose_test::servo_csv;
using diagnose_test::servo_model;
using diagnose_test::walk_model;
using diagnose_test::with;

namespace {

LoadedRecordings load(const std::string& csv, const std::string& model = servo_model) {
  return recordings_of(parse_csv(csv, "rec.csv"), layout_of(parse_model_file(model, "servo.toml")));
}

void check_recording_refused(const std::string& csv, const std::string& words, const std::string& model = servo_model) {
  CAPTURE(words);
  REQUIRE(!csv.empty());
  REQUIRE(!model.empty());
  try {
    load(csv, model);
    FAIL("not refused");
  } catch (const surefoot::DiagnoseError& error) {
    const std::string what = error.what();
    CAPTURE(what);
    CHECK(what.find("rec.csv") == 0);
    CHECK(what.find(words) != std::string::npos);
    CHECK(what.find('\n') == std::string::npos);
  }
}

std::string recordings_folder() {
  const char* folder = std::getenv("SUREFOOT_RECORDINGS");
  return folder != nullptr ? folder : "";
}

}  // namespace

TEST_CASE("columns become inputs and outputs, and the state starts where it was measured") {
  const auto loaded = load(servo_csv);
  REQUIRE(loaded.recordings.size() == 1);
  const surefoot::Recording& recording = loaded.recordings[0];
  CHECK(recording.name == "rec.csv");
  CHECK(recording.rows() == 7);
  CHECK(recording.inputs(0, 2) == 0.2);
  CHECK(std::isnan(recording.outputs(0, 2)));
  CHECK(recording.initial[0] == 0.01);
  CHECK(recording.initial_scale[0] == 0);
  CHECK(recording.constants.at("kp") == 5);
  CHECK(!recording.constants.contains("remark"));
}

TEST_CASE("a state whose first cell is empty starts on the line through its next readings, and may be off by that") {
  const surefoot::Recording empty = load(with(servo_csv, "0.000,0.0,0.01", "0.000,0.0,")).recordings[0];
  CHECK(empty.initial[0] == doctest::Approx(0.02 - 0.03 / 2));  // 0.02 at 5 ms, 0.05 at 15 ms
  CHECK(empty.initial_scale[0] == doctest::Approx(0.03 / 2));
  const std::string late = with(with(servo_csv, "0.000,0.0,0.01", "0.000,0.0,"), "0.005,0.1,0.02", "0.005,0.1,");
  const surefoot::Recording far = load(late).recordings[0];  // further back than the readings are apart
  CHECK(far.initial[0] == 0.05);
  CHECK(far.initial_scale[0] == 0);
}

TEST_CASE("a free state starts from its measurement, a free speed from the first differences") {
  const std::string csv = "t_s,goal_rad,theta_rad\n0,0,1\n0.1,0,1.2\n0.2,0,1.4\n0.3,0,1.6\n0.4,0,1.8\n0.5,0,3\n";
  std::string model = with(servo_model, "column:theta_rad", "free");
  model = with(model, "initial = \"0\"", "initial = \"free\"");
  for (const char* key : {"mass_kg", "length_m", "kp", "vin_V"})
    model = with(model, "\"meta:" + std::string(key) + "\"", "1.0");
  const auto loaded = load(csv, model);
  CHECK(loaded.recordings[0].initial[0] == 1);
  CHECK(loaded.recordings[0].initial[1] == doctest::Approx(2));
  CHECK(loaded.recordings[0].initial_scale.minCoeff() > 0);
}

TEST_CASE("a free state starts from a reading in another unit, one that is not read from another in its unit") {
  const auto loaded = load("t_s,pump_V,lower_V\n0,1,6\n1,1,8\n2,1,6\n3,1,8\n", R"(
schema = "surefoot.model/1"
name = "tanks"
kind = "ode"
time = "t_s"
[inputs]
pump = { column = "pump_V", unit = "V" }
[let]
between = "k1*upper + 0*rain"
[states]
upper = { rate = "pump - between", initial = "free", unit = "m" }
lower = { rate = "between - k2*lower + rain", initial = "free", unit = "m", force = "rain", effort_unit = "m/s" }
[outputs]
lower_V = { value = "zero + 50*lower", unit = "V" }
[constants]
zero = 1.0
[parameters]
k1 = { value = 1, min = 0.1, max = 10, unit = "1/s" }
k2 = { value = 1, min = 0.1, max = 10, unit = "1/s" }
)");
  for (const Eigen::Index state : {0, 1}) {
    CHECK(loaded.recordings[0].initial[state] == doctest::Approx(0.1));
    const double spread = 0.02, share = state == 0 ? 1 : 0.1;  // what is read itself is well known
    CHECK(loaded.recordings[0].initial_scale[state] == doctest::Approx(share * spread));
  }
}

TEST_CASE("sequences in one file are recordings of their own, and poses after a step belong to the next row") {
  const auto loaded = load("seq,order_m,turn_rad,x_m,y_m\n4,1,0,1,0\n4,2,0,3,0\n9,3,0,3,0\n", walk_model);
  REQUIRE(loaded.recordings.size() == 2);
  CHECK(loaded.recordings[1].name == "rec.csv#2");
  const surefoot::Recording& first = loaded.recordings[0];
  REQUIRE(first.rows() == 3);
  CHECK(std::isnan(first.outputs(0, 0)));
  CHECK(first.inputs(0, 0) == 1);
  CHECK(first.outputs(0, 1) == 1);
  CHECK(first.inputs(0, 1) == 2);
  CHECK(first.outputs(0, 2) == 3);
  CHECK(first.time[2] == 2);
}

TEST_CASE("rows at the beginning can be skipped") {
  const auto loaded = load(servo_csv, with(servo_model, "time ", "skip_rows = 3\ntime "));
  CHECK(loaded.recordings[0].rows() == 4);
  CHECK(loaded.recordings[0].initial[0] == 0.05);
  check_recording_refused(servo_csv, "only 7 row(s) of numbers, but at least 8 are needed (skip_rows = 6)",
                          with(servo_model, "time ", "skip_rows = 6\ntime "));
}

TEST_CASE("wrong recordings are refused in one sentence") {
  check_recording_refused(
      with(servo_csv, "goal_rad", "goal_deg"),
      "column 'goal_rad' is missing, which the model reads as an input; the file has t_s, goal_deg, theta_rad");
  check_recording_refused(with(servo_csv, "theta_rad", "theta"), "column 'theta_rad' is missing");
  check_recording_refused(with(servo_csv, "0.010,0.2", "0.001,0.2"),
                          "line 9: column 't_s' does not rise, 0.001 follows 0.005");
  check_recording_refused(with(servo_csv, "0.010,0.2", "0.005,0.2"), "does not rise");
  check_recording_refused(with(servo_csv, "0.010,0.2", ",0.2"), "line 9: column 't_s' is empty");
  check_recording_refused(with(servo_csv, "0.010,0.2", "0.010,"),
                          "line 9: column 'goal_rad' is empty; an input must be known");
  check_recording_refused(with(servo_csv, "0.010,0.2", "0.010,fast"), "line 9: column 'goal_rad' holds \"fast\"");
  check_recording_refused(with(servo_csv, "# kp: 5\n", ""),
                          "the model wants the constant 'kp', but no first line '# kp: number' is there");
  check_recording_refused(with(servo_csv, "# kp: 5", "# kp: high"), "its first line says 'high', which is no number");
  check_recording_refused(servo_csv.substr(0, servo_csv.find("0.005,0.1")), "only 1 row(s) of numbers");
  check_recording_refused(servo_csv.substr(0, servo_csv.find("0.000,0.0")), "only 0 row(s) of numbers");
  check_recording_refused(
      "# mass_kg: 0.5\n# length_m: 0.1\n# kp: 5\n# vin_V: 7.4\nt_s,goal_rad,theta_rad\n0,0,\n1,0,nan\n2,0,\n",
      "column 'theta_rad' holds no number at all");
  check_recording_refused(servo_csv, "column 'start_rad' is missing, with which the state starts",
                          with(servo_model, "column:theta_rad", "column:start_rad"));
}

TEST_CASE("a column without a unit is remarked on, unless the model says that it has none") {
  const std::string csv = with(servo_csv, "goal_rad", "goal_on");
  CHECK(load(csv, with(servo_model, "\"goal_rad\"", "\"goal_on\"")).remarks.size() == 1);
  CHECK(load(csv, with(servo_model, "\"goal_rad\"", "{ column = \"goal_on\", unit = \"1\" }")).remarks.empty());
}

TEST_CASE("a remark that several recordings share is made once") {
  const auto remarks = once_each({{"a.csv", "no unit"}, {"a.csv", "one outlier"}, {"b.csv", "no unit"}});
  REQUIRE(remarks.size() == 2);
  CHECK(remarks[0].recording.empty());
  CHECK(remarks[0].text == "no unit, in 2 recordings");
  CHECK(remarks[1].recording == "a.csv");
  CHECK(remarks[1].text == "one outlier");
}

TEST_CASE("a simulator in C++ reads columns called after names and units") {
  surefoot::SimulatorInfo info;
  info.inputs = {{"goal", "rad"}, {"v", "m/s"}, {"on", "1"}};
  info.outputs = {{"theta_rad", "rad"}, {"tau", "N m"}};
  info.states = {{"theta", "rad"}, {"omega", "rad/s"}};
  const Layout layout = layout_of(info);
  CHECK(layout.inputs[0].column == "goal_rad");
  CHECK(layout.inputs[1].column == "v_m_s");
  CHECK(layout.inputs[2].column == "on");
  CHECK(layout.outputs == std::vector<std::string>{"theta_rad", "tau_N_m"});
  CHECK(layout.starts[0].measured.output == 0);
  CHECK(layout.starts[1].speed_of.output == 0);
}

TEST_CASE("every model of ours reads the recordings it is for" * doctest::skip(recordings_folder().empty())) {
  namespace fs = std::filesystem;
  std::size_t models = 0;
  for (const auto& entry : fs::directory_iterator(SUREFOOT_SOURCE_DIR "/apps/diagnose/models")) {
    fs::path folder = fs::path(recordings_folder()) / entry.path().stem();
    if (fs::exists(folder / "as_recordings")) folder /= "as_recordings";
    CAPTURE(entry.path().string());
    REQUIRE(fs::exists(folder));
    const ModelFile model = read_model_file(entry.path());
    const Layout layout = layout_of(model);
    Eigen::VectorXd p(static_cast<Eigen::Index>(model.parameters.size()));
    for (std::size_t i = 0; i < model.parameters.size(); ++i)
      p[static_cast<Eigen::Index>(i)] = model.parameters[i].value;
    std::size_t files = 0;
    for (const auto& file : fs::directory_iterator(folder)) {
      if (file.path().extension() != ".csv") continue;
      ++files;
      for (const auto& recording : load_recordings(file.path(), layout).recordings) {
        CAPTURE(recording.name);
        CHECK(recording.rows() > 20);
        CHECK(recording.initial.allFinite());
        const Channels x = recording.initial, u = recording.inputs.col(0);
        if (layout.ode) {
          OdeModel bound = OdeModel(model).for_recording(recording);
          bound.prepare(p);
          CHECK(bound.derivative(x, u, p).allFinite());
        } else {
          MapModel bound = MapModel(model).for_recording(recording);
          bound.prepare(p);
          CHECK(bound.next(x, u, p).allFinite());
        }
      }
    }
    CHECK(files > 0);
    ++models;
  }
  CHECK(models == 12);
}
