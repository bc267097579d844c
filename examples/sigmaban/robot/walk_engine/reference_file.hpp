// Files of joint targets that an engine must reproduce: CSV, one row per phase of a walk.
//
// Columns, in any order: `phase` [cycle]; the twelve joint_names, each with `_rad`; `reachable`, 1 or 0 (else 1);
// `case`, a name; and any of find_setting(). What has no column has its default. The joints of a row that is not
// reachable are not read.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "joint_targets.hpp"
#include "surefoot/core/error.hpp"
#include "walk_parameter_names.hpp"

namespace sigmaban {

/// A file that is not as described above; the message names line and column.
struct ReferenceError : surefoot::Error {
  using Error::Error;
};

struct ReferenceRow {
  std::size_t line = 0;  // of the file, from 1
  std::string name;      // of the case
  WalkSettings settings;
  double phase = 0;  // [cycle]
  bool reachable = true;
  std::array<double, 12> joints{};  // in the order of joint_names [rad]
};

namespace reference_detail {

inline std::vector<std::string> cells_of(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    std::string_view cell = line.substr(begin, end - begin);
    while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t')) cell.remove_suffix(1);
    cells.emplace_back(cell);
    begin = end + 1;
  }
  return cells;
}

/// The beginning of a cell or name, on one line.
inline std::string shown(std::string_view text) {
  std::string result(text.substr(0, 40));
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return "'" + result + "'";
}

inline double finite_number(const std::string& cell, std::size_t line, const std::string& column) {
  double value = 0;
  const char* begin = cell.data() + (cell.starts_with('+') ? 1 : 0);
  const char* end = cell.data() + cell.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end || begin == end || !std::isfinite(value)) {
    throw ReferenceError("line " + std::to_string(line) + ", column " + column + ": " + shown(cell) +
                         " is not a finite number");
  }
  return value;
}

/// What a column holds: one of the numbers of a row. Null for the name of the case.
inline double* find_number(ReferenceRow& row, double& reachable, std::string_view column) {
  if (column == "phase") return &row.phase;
  if (column == "reachable") return &reachable;
  for (std::size_t i = 0; i < joint_names.size(); ++i) {
    if (without_unit(column) == joint_names[i]) return &row.joints[i];
  }
  return find_setting(row.settings, column);
}

inline bool is_joint(std::string_view column) {
  for (const auto name : joint_names) {
    if (without_unit(column) == name) return true;
  }
  return false;
}

inline void check_columns(const std::vector<std::string>& columns) {
  ReferenceRow row;
  double reachable = 1;
  std::vector<const double*> seen;
  for (const std::string& column : columns) {
    if (column == "case") continue;
    const double* number = find_number(row, reachable, column);
    if (number == nullptr) throw ReferenceError("line 1: there is no column called " + shown(column));
    for (const double* other : seen) {
      if (other == number) throw ReferenceError("line 1: column " + shown(column) + " is there twice");
    }
    seen.push_back(number);
  }
  const auto require = [&](std::string_view column, const double* number) {
    for (const double* other : seen) {
      if (other == number) return;
    }
    throw ReferenceError("line 1: column '" + std::string(column) + "' is missing");
  };
  require("phase", &row.phase);
  for (std::size_t i = 0; i < joint_names.size(); ++i) require(std::string(joint_names[i]) + "_rad", &row.joints[i]);
}

}  // namespace reference_detail

/// All rows; throws ReferenceError. Empty lines are skipped.
inline std::vector<ReferenceRow> read_reference(std::istream& file) {
  using namespace reference_detail;
  std::string text;
  if (!std::getline(file, text)) throw ReferenceError("line 1: the names of the columns are missing");
  const std::vector<std::string> columns = cells_of(text);
  check_columns(columns);

  std::vector<ReferenceRow> rows;
  for (std::size_t line = 2; std::getline(file, text); ++line) {
    if (text.empty() || text == "\r") continue;
    const std::vector<std::string> cells = cells_of(text);
    if (cells.size() != columns.size()) {
      throw ReferenceError("line " + std::to_string(line) + ": " + std::to_string(cells.size()) + " cells where " +
                           std::to_string(columns.size()) + " were expected");
    }
    ReferenceRow& row = rows.emplace_back();
    row.line = line;
    double reachable = 1;
    for (const bool joints : {false, true}) {  // whether the joints count is known after the others
      for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i] == "case") {
          row.name = cells[i];
        } else if (is_joint(columns[i]) == joints && (!joints || row.reachable)) {
          *find_number(row, reachable, columns[i]) = finite_number(cells[i], line, columns[i]);
        }
      }
      if (reachable != 0 && reachable != 1) {
        throw ReferenceError("line " + std::to_string(line) + ", column reachable: 0 or 1 was expected");
      }
      row.reachable = reachable != 0;
    }
  }
  if (rows.empty()) throw ReferenceError("line 2: no row follows the names of the columns");
  return rows;
}

}  // namespace sigmaban
