#include "columns.hpp"

#include <algorithm>
#include <numbers>
#include <string_view>
#include <utility>

#include "../diagnose/names.hpp"
#include "../diagnose/units.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace calibrate_program {
namespace {

using diagnose_program::Csv;
using diagnose_program::CsvColumn;
using diagnose_program::in_quotes;
using diagnose_program::listed;
using surefoot::MotionError;

/// What one component may be called, without its unit.
struct Component {
  std::string_view what;
  std::string_view example;
  bool angle;
  std::vector<std::string_view> names;
};

const std::array<Component, 3>& command_components() {
  static const std::array<Component, 3> components{{
      {"the command forward", "order_dx_m", false, {"order_dx", "order_x", "order_forward", "dx", "forward"}},
      {"the command to the left", "order_dy_m", false, {"order_dy", "order_y", "order_lateral", "dy", "lateral"}},
      {"the command to turn",
       "order_dtheta_rad",
       true,
       {"order_dtheta", "order_dt", "order_theta", "order_turn", "dtheta", "turn", "dyaw"}},
  }};
  return components;
}

const std::array<Component, 3>& pose_components() {
  static const std::array<Component, 3> components{{
      {"the position forward", "x_m", false, {"x", "pose_x"}},
      {"the position to the left", "y_m", false, {"y", "pose_y"}},
      {"the heading", "theta_rad", true, {"theta", "heading", "yaw", "pose_theta", "pose_yaw"}},
  }};
  return components;
}

std::optional<double> factor_of(const std::string& column, bool angle) {
  return angle ? angle_factor(column) : length_factor(column);
}

bool has(const Csv& csv, const std::string& name) {
  return std::ranges::find(csv.columns, name, &CsvColumn::name) != csv.columns.end();
}

std::vector<std::string> names_of(const Csv& csv) {
  std::vector<std::string> names;
  for (const CsvColumn& column : csv.columns) names.push_back(column.name);
  return names;
}

Column named_column(const Csv& csv, const std::string& name, const Component& component) {
  if (!has(csv, name)) {
    throw MotionError(csv.file + ": column " + in_quotes(name) + " is missing" +
                      diagnose_program::suggestion(name, names_of(csv)));
  }
  const auto factor = factor_of(name, component.angle);
  if (!factor) {
    throw MotionError(csv.file + ": column " + in_quotes(name) + " (" + std::string(component.what) +
                      ") does not end in a unit; rename it so that it ends in " +
                      (component.angle ? "_rad or _deg" : "_m, _cm or _mm"));
  }
  return {name, *factor};
}

std::optional<Column> recognised_column(const Csv& csv, const Component& component) {
  for (const std::string_view base : component.names) {
    for (const CsvColumn& column : csv.columns) {
      if (column.name == base) return named_column(csv, column.name, component);  // throws: it has no unit
      const bool fits = column.name.starts_with(std::string(base) + "_") && factor_of(column.name, component.angle) &&
                        column.name.find('_', base.size() + 1) == std::string::npos;
      if (fits) return named_column(csv, column.name, component);
    }
  }
  return std::nullopt;
}

[[noreturn]] void fail_missing(const Csv& csv, const Component& component, const std::string& option) {
  throw MotionError(csv.file + ": no column was recognised as " + std::string(component.what) + ", like " +
                    in_quotes(component.example) + "; name it by " + option + " (the file has " +
                    listed(names_of(csv)) + ")");
}

std::array<Column, 3> wheel_columns(const Csv& csv, const std::vector<std::string>& wheels) {
  std::array<Column, 3> result;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string& name = wheels[i];
    if (!has(csv, name)) {
      throw MotionError(csv.file + ": column " + in_quotes(name) + " is missing" +
                        diagnose_program::suggestion(name, names_of(csv)));
    }
    const std::string unit = diagnose_program::unit_of_column(name);
    constexpr std::array<std::pair<std::string_view, double>, 3> units{{{"m/s", 1}, {"cm/s", 0.01}, {"mm/s", 0.001}}};
    const auto known = std::ranges::find(units, unit, &std::pair<std::string_view, double>::first);
    if (known == units.end()) {
      throw MotionError(csv.file + ": column " + in_quotes(name) +
                        " (the speed of a wheel) must end in _m_s, _cm_s or _mm_s");
    }
    result[i] = {name, known->second};
  }
  if (!has(csv, "t_s")) {
    throw MotionError(csv.file + ": column 't_s' is missing; speeds of wheels need the time of each row in seconds");
  }
  result[2] = {"t_s", 1};
  return result;
}

}  // namespace

std::optional<double> length_factor(const std::string& column) {
  const std::string unit = diagnose_program::unit_of_column(column);
  if (unit == "m") return 1;
  if (unit == "cm") return 0.01;
  if (unit == "mm") return 0.001;
  return std::nullopt;
}

std::optional<double> angle_factor(const std::string& column) {
  const std::string unit = diagnose_program::unit_of_column(column);
  if (unit == "rad") return 1;
  if (unit == "mrad") return 0.001;
  if (unit == "deg") return std::numbers::pi / 180;
  return std::nullopt;
}

Columns recognise_columns(const Csv& csv, const ColumnNames& named, bool poses_needed) {
  Columns columns;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!named.wheels.empty()) break;
    const Component& component = command_components()[i];
    if (!named.commands.empty()) {
      columns.commands[i] = named_column(csv, named.commands[i], component);
      continue;
    }
    const auto found = recognised_column(csv, component);
    if (!found) fail_missing(csv, component, "--commands X,Y,TURN, or for wheels --wheels LEFT,RIGHT");
    columns.commands[i] = *found;
  }
  if (!named.wheels.empty()) columns.commands = wheel_columns(csv, named.wheels);
  for (std::size_t i = 0; i < 3; ++i) {
    const Component& component = pose_components()[i];
    if (i < named.pose.size()) {
      columns.pose[i] = named_column(csv, named.pose[i], component);
    } else if (named.pose.empty()) {
      columns.pose[i] = recognised_column(csv, component);
    }
    if (!columns.pose[i] && i < 2 && poses_needed) fail_missing(csv, component, "--pose X,Y,HEADING");
  }
  return columns;
}

}  // namespace calibrate_program
