// The command that holds a walk engine against a file of joint targets; what main() of such a program calls.
#pragma once

#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "compare_with_reference.hpp"

namespace sigmaban {

/// Prints the largest joint error. 0: at most 1e-9 rad, and reachability agrees in all rows; 1: not so; 2: bad input,
/// said in one sentence.
template <class Make>
int check_engine(int argc, const char* const* argv, Make make) {
  constexpr double tolerance = 1e-9;  // [rad]
  if (argc != 2) {
    std::cerr << "One argument was expected, the CSV file of joint targets to compare with.\n";
    return 2;
  }
  const std::string path = argv[1];
  std::ifstream file(path);
  if (!file) {
    std::cerr << path << ": the file cannot be opened.\n";
    return 2;
  }
  std::vector<ReferenceRow> rows;
  try {
    rows = read_reference(file);
  } catch (const ReferenceError& error) {
    std::cerr << path << ": " << error.what() << ".\n";
    return 2;
  }

  const ReferenceComparison result = compare_with_reference(rows, make);
  const auto where = [](const ReferenceRow& row) {
    return "line " + std::to_string(row.line) + (row.name.empty() ? "" : ", case " + row.name);
  };
  std::cout << rows.size() << " rows, " << result.reachable << " with targets\n";
  if (result.worst != nullptr) {
    std::cout << "largest joint error: " << result.largest_error << " rad (" << joint_names[result.joint] << ", "
              << where(*result.worst) << ")\n";
  }
  if (result.disagreements > 0) {
    std::cout << "reachability differs in " << result.disagreements << " rows, first in " << where(*result.disagreement)
              << ": the file says " << (result.disagreement->reachable ? "reachable" : "not reachable") << "\n";
  }
  std::cout << (result.agrees(tolerance) ? "agrees" : "does not agree") << " to " << tolerance << " rad\n";
  return result.agrees(tolerance) ? 0 : 1;
}

}  // namespace sigmaban
