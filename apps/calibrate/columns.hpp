// Columns of a CSV that hold commands and poses, and their units.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "../diagnose/csv.hpp"

namespace calibrate_program {

/// A column, and what its numbers are multiplied with to be in metres or radians.
struct Column {
  std::string name;
  double factor = 1;
};

struct Columns {
  std::array<Column, 3> commands;             // x, y, turn; of wheels: left, right, time
  std::array<std::optional<Column>, 3> pose;  // x, y, heading; the heading may be missing
};

/// What the user says about columns; empty where they are to be recognised.
struct ColumnNames {
  std::vector<std::string> commands, pose, wheels;
};

/// Throws surefoot::MotionError that names file and column. A file of commands alone has no poses.
Columns recognise_columns(const diagnose_program::Csv& csv, const ColumnNames& named, bool poses_needed);

/// The unit's factor to metres ("cm") or radians ("deg"), or nothing for a column whose name ends in no such unit.
std::optional<double> length_factor(const std::string& column);
std::optional<double> angle_factor(const std::string& column);

}  // namespace calibrate_program
