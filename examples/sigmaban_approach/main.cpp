// sigmaban_approach: trains, tunes, evaluates, draws and exports policies of the ball approach.
// Exit codes: 0 done, 1 a defect of this program, 2 bad options or files, 130 stopped by Ctrl-C (the best is kept).
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <exception>
#include <iostream>

#include "commands.hpp"
#include "surefoot/core/error.hpp"

namespace {

int fail(const char* message, int code) {
  std::cerr << "sigmaban_approach: " << message << '\n';
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program{"Policies for the ball approach of the humanoid robot Sigmaban", "sigmaban_approach"};
  program.require_subcommand(1);
  sigmaban::add_train(program);
  sigmaban::add_tune(program);
  sigmaban::add_evaluate(program);
  sigmaban::add_trajectories(program);
  sigmaban::add_export(program);
  sigmaban::add_table(program);
  try {
    program.parse(argc, argv);
    return EXIT_SUCCESS;
  } catch (const CLI::CallForHelp& help) {
    return program.exit(help);
  } catch (const CLI::CallForAllHelp& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    return fail((std::string(error.what()) + "; see sigmaban_approach --help").c_str(), 2);
  } catch (const sigmaban::Interrupted&) {
    return 130;
  } catch (const surefoot::Error& error) {
    return fail(error.what(), 2);
  } catch (const std::exception& error) {
    return fail(error.what(), EXIT_FAILURE);
  }
}
