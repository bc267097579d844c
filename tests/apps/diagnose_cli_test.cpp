// Runs the program surefoot-diagnose itself.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "surefoot/core/rng.hpp"
#include "tests/apps/diagnose_models.hpp"
#include "tests/support/program.hpp"

using approach_program::Outcome;
using approach_program::ScratchFolder;
using approach_program::write_text;
using nlohmann::json;

namespace {

std::string program() { return SUREFOOT_BIN_DIR "/surefoot-diagnose"; }
bool program_exists() { return std::filesystem::exists(program()); }
Outcome run(const std::string& arguments) { return approach_program::run_command(program() + " " + arguments); }

/// One line that holds `words`, exit code 2, and nothing in the folder of the results.
void check_call_refused(const ScratchFolder& folder, const std::string& arguments, const std::string& words) {
  CAPTURE(arguments);
  const Outcome result = run(arguments);
  CAPTURE(result.output);
  CHECK(result.code == 2);
  CHECK(result.output.starts_with("surefoot-diagnose: "));
  CHECK(result.output.find('\n') == result.output.size() - 1);
  CHECK(result.output.find(words) != std::string::npos);
  CHECK(!std::filesystem::exists(folder.path() / "out" / "diagnosis.json"));
}

/// A servo pendulum that drags itself through honey: the model of servo_model and viscous friction of 0.3 N m s/rad.
std::string recording(std::uint64_t seed, double friction) {
  surefoot::Rng rng(seed);
  std::string text = "# mass_kg: 0.5\n# length_m: 0.1\n# kp: 5\n# vin_V: 7.4\nt_s,goal_rad,theta_rad\n";
  double theta = 0.01, omega = 0, goal = 0;
  constexpr double step = 0.0005;
  constexpr int rows = 300, steps_per_row = 10;
  for (int row = 0; row < rows; ++row) {
    if (row % 40 == 0) goal = 2 * rng.uniform() - 1;
    char line[80];
    std::snprintf(line, sizeof line, "%.4f,%.4f,%.5f\n", row * step * steps_per_row, goal,
                  theta + 0.001 * (2 * rng.uniform() - 1));
    text += line;
    for (int i = 0; i < steps_per_row; ++i) {
      const double duty = std::min(std::max(5 * (goal - theta), -1.0), 1.0);
      const double tau = 1.6 / 3.6 * (7.4 * duty - 1.6 * omega) - friction * omega;
      omega += step * (tau - 0.5 * 9.81 * 0.1 * std::sin(theta)) / 0.017;
      theta += step * omega;
    }
  }
  return text;
}

std::string files(const ScratchFolder& folder) {
  std::string names;
  for (int i = 1; i <= 5; ++i) names += " " + folder.file("rec_" + std::to_string(i) + ".csv");
  return names;
}

void write_case(const ScratchFolder& folder) {
  write_text(folder.file("servo.toml"), diagnose_test::servo_model);
  for (int i = 1; i <= 5; ++i) {
    write_text(folder.file("rec_" + std::to_string(i) + ".csv"), recording(static_cast<std::uint64_t>(i), 0.3));
  }
}

}  // namespace

TEST_SUITE("surefoot-diagnose" * doctest::skip(!program_exists())) {
  TEST_CASE("wrong options are refused in one sentence") {
    const ScratchFolder folder;
    write_case(folder);
    const std::string out = " --out " + folder.file("out"), model = " --model " + folder.file("servo.toml");
    check_call_refused(folder, "", "required");
    check_call_refused(folder, out + files(folder), "--model is required");
    check_call_refused(folder, model + files(folder), "--out is required");
    check_call_refused(folder, model + out, "recordings is required");
    check_call_refused(folder, model + out + " --test-share 2" + files(folder), "--test-share");
    check_call_refused(folder, model + out + " --max-effects many" + files(folder), "--max-effects");
    check_call_refused(folder, model + out + " --budget -1" + files(folder), "--budget");
    check_call_refused(folder, model + out + " --effects coulomb" + files(folder), "did you mean 'coulomb_friction'?");
    check_call_refused(folder, model + out + " --effects friction" + files(folder), "known are ");
    check_call_refused(folder, model + out + " --speed 3" + files(folder), "--speed");
    check_call_refused(folder, model + out + " --test nothing.csv" + files(folder), "nothing.csv");
    check_call_refused(folder, model + out + files(folder) + files(folder), "named twice");
  }

  TEST_CASE("files that cannot be used are refused in one sentence, and nothing is written") {
    const ScratchFolder folder;
    write_case(folder);
    const std::string out = " --out " + folder.file("out"), model = " --model " + folder.file("servo.toml");
    check_call_refused(folder, " --model " + folder.file("none.toml") + out + files(folder), "none.toml");
    check_call_refused(folder, " --model " + folder.path().string() + out + files(folder), "is a folder");
    check_call_refused(folder, model + out + " " + folder.file("none.csv"), "none.csv");
    write_text(folder.file("empty.csv"), "");
    check_call_refused(folder, model + out + " " + folder.file("empty.csv"), "empty.csv: the file is empty");
    write_text(folder.file("one.csv"),
               "# mass_kg: 1\n# length_m: 1\n# kp: 1\n# vin_V: 1\nt_s,goal_rad,theta_rad\n0,0,0\n");
    check_call_refused(folder, model + out + " " + folder.file("one.csv"), "one.csv: only 1 row(s)");
    check_call_refused(folder, model + " --out " + folder.file("servo.toml") + "/inside" + files(folder), "--out");
  }

  TEST_CASE("help goes to the standard output, with an example, and succeeds") {
    const Outcome result = run("--help");
    CHECK(result.code == 0);
    CHECK(result.output.find("--test-share") != std::string::npos);
    CHECK(result.output.find("Example:") != std::string::npos);
  }

  TEST_CASE("a diagnosis leaves its files, and the augmented model can be diagnosed again") {
    const ScratchFolder folder;
    write_case(folder);
    const std::string out = folder.file("out");
    const Outcome result =
        run("--model " + folder.file("servo.toml") + " --out " + out +
            " --max-effects 1 --effects viscous_friction,constant_force --test rec_5.csv" + files(folder));
    CAPTURE(result.output);
    REQUIRE(result.code == 0);
    for (const char* name : {"diagnosis.json", "report.html", "augmented.toml", "curve_1.svg"}) {
      CAPTURE(name);
      CHECK(std::filesystem::exists(std::filesystem::path(out) / name));
    }
    std::ifstream file(out + "/diagnosis.json");
    const json diagnosis = json::parse(file);
    CHECK(diagnosis.at("complete") == true);
    CHECK(diagnosis.at("recordings").at("test") == json({"rec_5.csv"}));
    for (const auto& entry : std::filesystem::directory_iterator(out)) CHECK(entry.path().extension() != ".part");
    const Outcome again =
        run("--quiet --max-effects 0 --model " + out + "/augmented.toml --out " + out + "/again" + files(folder));
    CAPTURE(again.output);
    CHECK(again.code == 0);
    CHECK(again.output.empty());
  }

  TEST_CASE("an interrupted diagnosis ends soon, says so and keeps what it has") {
    const ScratchFolder folder;
    write_case(folder);
    const std::string out = folder.file("out");
    const Outcome result =
        approach_program::run_command("timeout --foreground --preserve-status -s INT 0.7 " + program() + " --model " +
                                      folder.file("servo.toml") + " --out " + out + files(folder));
    CAPTURE(result.output);
    if (result.code != 0 && !result.output.empty()) {  // it had begun, and was not done before
      CHECK(result.code == 130);
      std::ifstream file(out + "/diagnosis.json");
      CHECK(json::parse(file).at("complete") == false);
    }
  }
}
