// surefoot-calibrate: a motion model from commands and a tape measure, with its noise.

#include "../common/command.hpp"
#include "commands.hpp"

namespace {

constexpr const char* usage = R"(Example: plan an experiment, walk it, measure where the robot ends, calibrate.
  surefoot-calibrate plan --out walk
  surefoot-calibrate sheet --commands walk/commands.csv --sheet walk/sheet.csv --out walk/walks.csv
  surefoot-calibrate fit --out walk/fitted walk/walks.csv
`surefoot-calibrate fit --help` tells which files it reads.)";

}  // namespace

int main(int argc, char** argv) {
  example::Command program{"A motion model from commands and measured poses, with its noise", "surefoot-calibrate"};
  program.require_subcommand(1);
  program.footer(usage);
  calibrate_program::add_plan(program);
  calibrate_program::add_sheet(program);
  calibrate_program::add_fit(program);
  calibrate_program::add_curve(program);
  calibrate_program::add_update(program);
  calibrate_program::add_compare(program);
  calibrate_program::add_simulate(program);
  return example::run_program(program, argc, argv,
                              "stopped; of `curve` the splits that are done are kept, of others nothing is written");
}
