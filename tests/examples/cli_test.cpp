// Runs the program itself.
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "examples/sigmaban/approach/winner2016.hpp"
#include "tests/support/program.hpp"

using approach_program::program_exists;
using approach_program::run;
using approach_program::ScratchFolder;
using approach_program::write_text;

namespace {

/// Bad options and files: one line on stderr that holds `words`, nothing on stdout, exit code 2.
void check_refused(const std::string& arguments, const std::string& words) {
  CAPTURE(arguments);
  const auto result = run(arguments);
  CAPTURE(result.output);
  CHECK(result.code == 2);
  CHECK(result.output.starts_with("sigmaban_approach: "));
  CHECK(result.output.find('\n') == result.output.size() - 1);
  CHECK(result.output.find(words) != std::string::npos);
}

std::string parameters_json(const std::string& changed = "", const std::string& value = "") {
  std::string text;
  for (const auto& parameter : sigmaban::winner2016_parameters) {
    const std::string name(parameter.name);
    if (name == changed && value.empty()) continue;
    const double number = sigmaban::Winner2016Parameters::tuned().*parameter.member;
    text += (text.empty() ? "\"" : ", \"") + name + "\": " + (name == changed ? value : std::to_string(number));
  }
  return R"({"policy": "winner2016", "parameters": {)" + text + "}}";
}

}  // namespace

TEST_SUITE("sigmaban_approach" * doctest::skip(!program_exists())) {
  TEST_CASE("bad options are refused in one sentence that names the option") {
    check_refused("", "subcommand");
    check_refused("dance", "subcommand");
    check_refused("evaluate --policy tuned", "--problem is required");
    check_refused("evaluate --problem hb --policy tuned", "hb");
    check_refused("evaluate --problem ha --policy tuned --trials 1", "--trials");
    check_refused("evaluate --problem ha --policy tuned --trials many", "--trials");
    check_refused("evaluate --problem ha --policy tuned --threads -1", "--threads");
    check_refused("evaluate --problem ha --policy tuned --speed 3", "--speed");
    check_refused("train --problem ha", "--out is required");
    check_refused("train --problem ha --budget 0 --out x", "--budget");
    check_refused("train --problem ha --preset best --out x", "best");
  }

  TEST_CASE("files that cannot be used are refused in one sentence that names the file") {
    const ScratchFolder folder;
    const std::string file = folder.file("policy");
    check_refused("evaluate --problem ha --policy " + file, file);
    check_refused("evaluate --problem ha --policy " + folder.path().string(), folder.path().string());
    write_text(file, "neither JSON nor a forest");
    check_refused("evaluate --problem ha --policy " + file, file);
    write_text(file, "");
    check_refused("evaluate --problem ha --policy " + file, file);
    check_refused("train --problem ha --budget 1 --out " + file + "/inside/a/file", file);
    check_refused("export --policy tuned --out " + folder.file("x.c"), "tuned");
  }

  TEST_CASE("a parameter file must hold every parameter once, as a finite number") {
    const ScratchFolder folder;
    const std::string file = folder.file("parameters.json");
    write_text(file, "{");
    check_refused("evaluate --problem ha --policy " + file, "not a JSON object");
    write_text(file, R"({"policy": "winner2016"})");
    check_refused("evaluate --problem ha --policy " + file, "\"parameters\"");
    write_text(file, parameters_json("step_p", ""));
    check_refused("evaluate --problem ha --policy " + file, "step_p");
    write_text(file, parameters_json("step_p", "\"fast\""));
    check_refused("evaluate --problem ha --policy " + file, "step_p");
    write_text(file, parameters_json("step_p", "1e999"));
    check_refused("evaluate --problem ha --policy " + file, file);
    write_text(file, parameters_json("step_p", "1, \"hop_p\": 1"));
    check_refused("evaluate --problem ha --policy " + file, "remove");
  }

  TEST_CASE("a parameter file with the tuned parameters is the tuned policy") {
    const ScratchFolder folder;
    const std::string file = folder.file("parameters.json");
    write_text(file, parameters_json());
    const auto cost = [](const std::string& policy) {
      const auto result = run("evaluate --problem anha --trials 500 --seed 3 --policy " + policy);
      REQUIRE(result.code == 0);
      const std::size_t at = result.output.find("cost ");
      REQUIRE(at != std::string::npos);
      return result.output.substr(at, result.output.find(" in ") - at);
    };
    CHECK(cost(file) == cost("tuned"));
    CHECK(cost(file) != cost("winner2016"));
  }

  TEST_CASE("evaluate gives the same cost for any number of threads") {
    const auto cost = [](const std::string& threads) {
      const std::string text =
          run("evaluate --problem ha --policy tuned --trials 1000 --json --threads " + threads).output;
      return text.substr(0, text.find("\"seconds\""));
    };
    CHECK(cost("1").find("\"cost\"") != std::string::npos);
    CHECK(cost("1") == cost("3"));
  }

  TEST_CASE("help goes to the standard output and succeeds") {
    const auto result = run("evaluate --help");
    CHECK(result.code == 0);
    CHECK(result.output.find("--trials") != std::string::npos);
  }
}
