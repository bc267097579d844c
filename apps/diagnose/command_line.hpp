// The options of the command line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace diagnose_program {

struct CommandLine {
  std::filesystem::path model;  // empty for a simulator in C++
  std::filesystem::path setup;  // of a robot: joints, columns, drives
  std::filesystem::path out;
  std::vector<std::filesystem::path> recordings;
  std::vector<std::string> test;  // recordings kept for the test
  std::vector<std::string> effects;
  double test_share = 0;
  int max_effects = 4;
  std::size_t max_rows = 40000;
  double budget = 0;  // [s], 0: none
  std::uint64_t seed = 1;
  std::size_t threads = 0;  // 0: as many as the machine has
  bool repair = false;  // faults of the log
  bool quiet = false;
};

/// Nothing if help was asked for and printed. Throws surefoot::DiagnoseError for wrong options.
std::optional<CommandLine> parse_command_line(int argc, const char* const* argv, bool with_model);

}  // namespace diagnose_program
