// From the command line to the exit code, for programs of subcommands.
// Exit codes: 0 done, 1 a defect of the program, 2 bad options or files, 130 stopped by Ctrl-C.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include "surefoot/core/error.hpp"
#include "usage_error.hpp"
#include "version_text.hpp"

namespace example {

/// Parses, which runs the subcommand, and tells an error in one line. `when_interrupted` is told after Ctrl-C.
inline int run_program(CLI::App& program, int argc, char** argv, const std::string& when_interrupted = "") {
  const auto fail = [&](std::string message, int code) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    if (!message.empty()) std::cerr << program.get_name() << ": " << message << '\n';
    return code;
  };
  program.set_version_flag("--version", version_text(program.get_name()));
  try {
    program.parse(argc, argv);
    return EXIT_SUCCESS;
  } catch (const CLI::Success& help_or_version) {
    return program.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    return fail(std::string(error.what()) + "; see " + program.get_name() + " --help", 2);
  } catch (const Interrupted&) {
    return fail(when_interrupted, 130);
  } catch (const surefoot::Error& error) {
    return fail(error.what(), 2);
  } catch (const std::exception& error) {
    return fail(error.what(), EXIT_FAILURE);
  }
}

}  // namespace example
