#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <iostream>

#include "../common/version_text.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace diagnose_program {
namespace {

constexpr const char* help_example = R"(Example:
  surefoot-diagnose --model servo.toml --out diagnosis rec_1.csv rec_2.csv rec_3.csv rec_4.csv

Says what physics the model leaves out of what the recordings show, or that nothing is missing. Writes into the folder
of --out: report.html (read this), diagnosis.json, augmented.toml, augmented.hpp, pictures, and residual.forest if
nothing explains what is missing but a forest on the residuals helps.
A robot in MuJoCo's format, told which columns belong to which joints; augmented.xml is the corrected model:
  surefoot-diagnose setup robot.xml log.csv > robot.toml
  surefoot-diagnose --model robot.xml --setup robot.toml --out diagnosis log.csv
Exit codes: 0 a verdict was reached; 2 wrong options or files; 130 stopped by Ctrl-C, what was known by then is kept.)";

constexpr double longest_budget = 1e6;  // [s]: twelve days

}  // namespace

std::optional<CommandLine> parse_command_line(int argc, const char* const* argv, bool with_model) {
  CommandLine line;
  CLI::App program{"Finds, names and models the physics that a simulator leaves out", "surefoot-diagnose"};
  program.footer(help_example);
  program.set_version_flag("--version", example::version_text(program.get_name()));
  if (with_model) {
    program.add_option("--model", line.model, "model file with the equations (TOML), or a robot (MJCF or URDF)")->required();
    program.add_option("--setup", line.setup, "setup of a robot (TOML); `surefoot-diagnose setup ROBOT LOG` prints a first one");
  }
  program.add_option("--out", line.out, "folder for the results, made if needed")->required();
  program.add_option("--test", line.test, "a recording kept for the test alone; may be given several times")
      ->allow_extra_args(false);
  program
      .add_option("--test-share", line.test_share,
                  "share of the recordings kept for the test if none is named; 0: each is held out once")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  program.add_option("--effects", line.effects, "names of the effects to consider, NAME,NAME,...; all by default")
      ->delimiter(',')
      ->allow_extra_args(false);
  program.add_option("--max-effects", line.max_effects, "effects to combine at most")
      ->check(CLI::Range(0, 16))
      ->capture_default_str();
  program.add_option("--max-rows", line.max_rows, "rows to use of all recordings together; of more, the first of each")
      ->check(CLI::Range(std::size_t{2}, std::size_t{1000000000}))
      ->capture_default_str();
  program.add_option("--budget", line.budget, "seconds after which calibration and search end; 0: no limit")
      ->check(CLI::Range(0.0, longest_budget));
  program.add_option("--seed", line.seed, "of all randomness; the same seed gives the same result")
      ->capture_default_str();
  program.add_option("--threads", line.threads, "0: as many as the machine has; results do not depend on it")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  program.add_flag(
      "--repair", line.repair,
      "repairs faults of the log that are found (signs, units, swapped columns, clocks, sensors), leaves out a "
      "recording unlike all others, and goes on with that; files stay as they are");
  program.add_flag("--quiet", line.quiet, "no progress and no summary, only files and errors");
  program.add_option("recordings", line.recordings, "recordings (CSV)")->required();
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    program.exit(help_or_version, std::cout, std::cerr);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    std::string what = error.what();
    for (char& c : what) {
      if (c == '\n') c = ' ';
    }
    throw surefoot::DiagnoseError(what + "; see surefoot-diagnose --help");
  }
  return line;
}

}  // namespace diagnose_program
