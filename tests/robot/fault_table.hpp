// The table of faults and reactions, as the README of the robot has it.
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace sigmaban {

struct FaultRow {
  std::string fault, reaction;
  double within_s = 0;  // from the fault to the reaction; 0 where there is none
  std::string torque;
};

/// Rows between the marks of the table.
inline std::vector<FaultRow> read_fault_table(const std::string& file) {
  std::ifstream in(file);
  std::vector<FaultRow> rows;
  std::string line;
  const auto trimmed = [](std::string text) {
    text.erase(0, text.find_first_not_of(' '));
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
  };
  for (bool inside = false; std::getline(in, line);) {
    if (line.find("<!-- faults -->") != std::string::npos) inside = true;
    if (line.find("<!-- end of faults -->") != std::string::npos) break;
    if (!inside || !line.starts_with("| ") || line.starts_with("| fault") || line.starts_with("| ---")) continue;
    std::vector<std::string> cells;
    std::istringstream row(line.substr(1));
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(trimmed(cell));
    if (cells.size() < 4) throw std::runtime_error("a row of the fault table has too few cells: " + line);
    rows.push_back({cells[0], cells[1], cells[2].empty() ? 0 : std::stod(cells[2]), cells[3]});
  }
  return rows;
}

}  // namespace sigmaban
