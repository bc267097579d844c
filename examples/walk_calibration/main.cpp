// surefoot-calibrate: a motion model from orders and a tape measure, with its noise.
// Exit codes: 0 done, 1 a defect of this program, 2 bad options or files, 130 stopped by Ctrl-C.
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include "commands.hpp"
#include "surefoot/core/error.hpp"

namespace {

int fail(std::string message, int code) {
  for (char& c : message) {
    if (c == '\n') c = ' ';
  }
  std::cerr << "surefoot-calibrate: " << message << '\n';
  return code;
}

constexpr const char* usage = R"(Example: plan an experiment, walk it, measure where the robot ends, calibrate.
  surefoot-calibrate plan --out walk
  surefoot-calibrate sheet --orders walk/orders.csv --sheet walk/sheet.csv --out walk/walks.csv
  surefoot-calibrate fit --out walk/fitted walk/walks.csv
`surefoot-calibrate fit --help` tells which files it reads.)";

}  // namespace

int main(int argc, char** argv) {
  CLI::App program{"A motion model from orders and measured poses, with its noise", "surefoot-calibrate"};
  program.require_subcommand(1);
  program.footer(usage);
  calibrate_program::add_plan(program);
  calibrate_program::add_sheet(program);
  calibrate_program::add_fit(program);
  calibrate_program::add_curve(program);
  calibrate_program::add_update(program);
  calibrate_program::add_simulate(program);
  try {
    program.parse(argc, argv);
    return EXIT_SUCCESS;
  } catch (const CLI::CallForHelp& help) {
    return program.exit(help);
  } catch (const CLI::CallForAllHelp& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    return fail(std::string(error.what()) + "; see surefoot-calibrate --help", 2);
  } catch (const example::Interrupted&) {
    return fail("stopped; nothing was written", 130);
  } catch (const surefoot::Error& error) {
    return fail(error.what(), 2);
  } catch (const std::exception& error) {
    return fail(error.what(), EXIT_FAILURE);
  }
}
