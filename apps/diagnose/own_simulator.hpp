// The same command line for a simulator of your own in C++:
//
//   int main(int argc, char** argv) { return surefoot_diagnose_main(argc, argv, MySimulator{}); }
//
// Columns of the recordings are called after the names and units of inputs and outputs ("goal_rad"), the time t_s.
#pragma once

#include <exception>
#include <functional>
#include <iostream>
#include <optional>
#include <string>

#include "run.hpp"
#include "surefoot/core/error.hpp"

namespace diagnose_program {

/// Reads the options, does the work, and turns what is thrown into one sentence and an exit code.
inline int guarded(int argc, char** argv, bool with_model, const std::function<int(const CommandLine&)>& work) {
  try {
    const std::optional<CommandLine> line = parse_command_line(argc, argv, with_model);
    return line ? work(*line) : exit_done;
  } catch (const surefoot::Error& error) {
    std::cerr << "surefoot-diagnose: " << error.what() << '\n';
    return exit_wrong_input;
  } catch (const std::exception& error) {
    std::cerr << "surefoot-diagnose: " << error.what() << '\n';
    return 1;
  }
}

}  // namespace diagnose_program

/// A constant from the first lines of a recording. Throws surefoot::DiagnoseError if it is not there.
inline double constant_of(const surefoot::Recording& recording, const std::string& key) {
  const auto found = recording.constants.find(key);
  if (found != recording.constants.end()) return found->second;
  throw surefoot::DiagnoseError(recording.name + ": the simulator wants the constant '" + key +
                                "'; add a first line '# " + key + ": number'");
}

template <surefoot::Simulator S>
int surefoot_diagnose_main(int argc, char** argv, const S& simulator) {
  using namespace diagnose_program;
  return guarded(argc, argv, false, [&simulator](const CommandLine& line) {
    return run(simulator, layout_of(simulator.info()), line, nullptr);
  });
}
