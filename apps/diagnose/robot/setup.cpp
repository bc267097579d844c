#include "setup.hpp"

#include <algorithm>
#include <numbers>
#include <sstream>

#include "../read_toml.hpp"
#include "../toml_table.hpp"
#include "../units.hpp"
#include "surefoot/core/binary.hpp"

namespace diagnose_robot {
namespace {

using diagnose_program::allow_keys;
using diagnose_program::entries;
using diagnose_program::fail;
using diagnose_program::find;
using diagnose_program::in_quotes;
using diagnose_program::place;
using diagnose_program::TomlEntry;
using diagnose_program::TomlTable;

constexpr std::size_t largest_file = 10'000'000;  // bytes

std::string text_or(const TomlTable& table, const std::string& key, const std::string& otherwise) {
  const toml::value* value = find(table, key);
  return value == nullptr ? otherwise : diagnose_program::to_text(*value, place(table, *value, key));
}

double number_or(const TomlTable& table, const std::string& key, double otherwise, double least) {
  const toml::value* value = find(table, key);
  if (value == nullptr) return otherwise;
  const double number = diagnose_program::to_number(*value, place(table, *value, key));
  if (number < least) fail(place(table, *value, key), "a number of at least " + std::to_string(least) + " is expected");
  return number;
}

std::vector<std::string> names_of(const TomlTable& table, const std::string& key, const toml::value& value) {
  const std::string where = place(table, value, key);
  if (!value.is_array()) fail(where, "a list of names in quotes is expected");
  std::vector<std::string> names;
  for (const toml::value& one : value.as_array()) names.push_back(diagnose_program::to_text(one, where));
  return names;
}

std::string choice(const TomlTable& table, const std::string& key, const std::string& otherwise,
                   const std::vector<std::string>& allowed) {
  const std::string text = text_or(table, key, otherwise);
  if (std::ranges::find(allowed, text) != allowed.end()) return text;
  fail(place(table, *find(table, key), key), in_quotes(text) + " is none of " + diagnose_program::listed(allowed));
}

double factor_of_unit(const TomlTable& table, const toml::value& value, const std::string& unit) {
  if (unit == "deg" || unit == "deg/s") return std::numbers::pi / 180;
  if (unit == "rad" || unit == "rad/s" || unit == "N m" || unit == "Nm" || unit == "N" || unit == "m" || unit == "m/s")
    return 1;
  if (unit == "rpm") return std::numbers::pi / 30;
  if (unit == "mm" || unit == "mm/s" || unit == "mN m") return 1e-3;
  fail(place(table, value),
       "the unit " + in_quotes(unit) + " is not known; rad, deg, rad/s, deg/s, rpm, N m, m, mm, N are");
}

// "column", or { column = "...", unit = "deg", factor = 0.1 }
ColumnOf read_column(const TomlTable& table, const std::string& key) {
  const toml::value* value = find(table, key);
  if (value == nullptr) return {};
  ColumnOf column;
  std::string unit;
  if (value->is_table()) {
    const TomlTable inner = diagnose_program::sub_table(table, {key, value}, "a column");
    allow_keys(inner, {"column", "unit", "factor"});
    column.name = diagnose_program::required_text(inner, "column", "name the column");
    unit = text_or(inner, "unit", "");
    if (const toml::value* factor = find(inner, "factor")) {
      column.factor = diagnose_program::to_number(*factor, place(inner, *factor, "factor"));
      if (column.factor == 0) fail(place(inner, *factor, "factor"), "0 would erase the column");
    }
  } else {
    column.name = diagnose_program::to_text(*value, place(table, *value, key));
  }
  if (unit.empty()) {
    unit = diagnose_program::unit_of_column(column.name);
    if (unit != "deg" && unit != "deg/s" && unit != "rpm" && unit != "mm" && unit != "mm/s" && unit != "mN m")
      return column;
  }
  column.factor *= factor_of_unit(table, *value, unit);
  return column;
}

struct DriveNumbers {
  double kp = 0, kd = 0, limit = 0;
};

DriveNumbers read_drive_numbers(const TomlTable& table, DriveNumbers otherwise) {
  otherwise.kp = number_or(table, "kp", otherwise.kp, 0);
  otherwise.kd = number_or(table, "kd", otherwise.kd, 0);
  otherwise.limit = number_or(table, "limit", otherwise.limit, 0);
  return otherwise;
}

void read_joint(const TomlTable& table, const std::string& name, const DriveNumbers& drive, RobotSetup& setup) {
  allow_keys(table, {"goal", "angle", "speed", "torque", "kp", "kd", "limit"});
  JointSetup joint;
  joint.name = name;
  joint.goal = read_column(table, "goal");
  joint.angle = read_column(table, "angle");
  joint.speed = read_column(table, "speed");
  joint.torque = read_column(table, "torque");
  const DriveNumbers own = read_drive_numbers(table, drive);
  joint.kp = own.kp;
  joint.kd = own.kd;
  joint.limit = own.limit;
  const std::string where = place(table, *table.value);
  if (joint.angle.name.empty())
    fail(where, "the key 'angle' is missing: the column of the measured position, or list the joint in held");
  if (setup.drive == DriveKind::position && joint.goal.name.empty()) {
    fail(where, "the key 'goal' is missing: the column of what the position drive is told");
  }
  if (setup.drive == DriveKind::position && !(joint.kp > 0))
    fail(where, "kp is missing: a position drive needs it, here or in [drive]");
  if (setup.drive == DriveKind::torque && joint.torque.name.empty()) {
    fail(where, "the key 'torque' is missing: the column of the torque that drives the joint");
  }
  setup.joints.push_back(joint);
}

void read_groups(const TomlTable& table, RobotSetup& setup) {
  std::vector<std::string> placed;
  for (const TomlEntry& entry : entries(table)) {
    Group group{entry.key, names_of(table, entry.key, *entry.value)};
    for (const std::string& joint : group.joints) {
      const std::string where = place(table, *entry.value, entry.key);
      if (std::ranges::find(setup.joints, joint, &JointSetup::name) == setup.joints.end()) {
        fail(where, "the joint " + in_quotes(joint) + " has no table under [joints]");
      }
      if (std::ranges::find(placed, joint) != placed.end())
        fail(where, "the joint " + in_quotes(joint) + " is in two groups");
      placed.push_back(joint);
    }
    if (!group.joints.empty()) setup.groups.push_back(group);
  }
}

void read_head(const TomlTable& root, RobotSetup& setup) {
  const std::string schema = text_or(root, "schema", "");
  if (schema != "surefoot.robot/1") {
    throw surefoot::DiagnoseError(setup.file +
                                  ": the first line must be schema = \"surefoot.robot/1\"; `surefoot-diagnose setup "
                                  "robot.xml log.csv` writes such a file");
  }
  setup.time = text_or(root, "time", setup.time);
  const std::string unit = diagnose_program::unit_of_column(setup.time);
  setup.time_factor = unit == "ms" ? 1e-3 : unit == "us" ? 1e-6 : 1;
  setup.base_held = choice(root, "base", "fixed", {"fixed", "held"}) == "held";
  setup.ignore_contacts = choice(root, "contacts", "none", {"none", "ignore"}) == "ignore";
  setup.from_model = choice(root, "friction_of_the_file", "nominal", {"nominal", "ignore"}) == "nominal";
  setup.step = number_or(root, "step", 0, 0);
  if (const toml::value* held = find(root, "held")) setup.held = names_of(root, "held", *held);
  if (const toml::value* gravity = find(root, "gravity")) {
    const std::string where = place(root, *gravity, "gravity");
    if (!gravity->is_array() || gravity->as_array().size() != 3) fail(where, "three numbers are expected");
    setup.gravity.emplace();
    for (std::size_t i = 0; i < 3; ++i)
      (*setup.gravity)[i] = diagnose_program::to_number(gravity->as_array()[i], where);
  }
  const toml::value* calibrate = find(root, "calibrate");
  if (calibrate == nullptr) return;
  const auto names = names_of(root, "calibrate", *calibrate);
  for (const std::string& name : names) {
    if (name != "gains" && name != "bodies") {
      fail(place(root, *calibrate, "calibrate"), in_quotes(name) + " is none of gains, bodies");
    }
  }
  setup.calibrate_gains = std::ranges::find(names, "gains") != names.end();
  setup.calibrate_bodies = std::ranges::find(names, "bodies") != names.end();
}

RobotSetup read_tables(const toml::value& value, const std::string& file) {
  RobotSetup setup;
  setup.file = file;
  const TomlTable root{&value, file, ""};
  allow_keys(root, {"schema", "time", "base", "contacts", "gravity", "step", "held", "calibrate",
                    "friction_of_the_file", "drive", "joints", "groups"});
  read_head(root, setup);
  DriveNumbers drive;
  if (const toml::value* table = find(root, "drive")) {
    const TomlTable inner = diagnose_program::sub_table(root, {"drive", table}, "a table of the drives");
    allow_keys(inner, {"kind", "kp", "kd", "limit"});
    setup.drive =
        choice(inner, "kind", "position", {"position", "torque"}) == "torque" ? DriveKind::torque : DriveKind::position;
    drive = read_drive_numbers(inner, drive);
  }
  const toml::value* joints = find(root, "joints");
  if (joints == nullptr)
    throw surefoot::DiagnoseError(file + ": there is no table [joints.NAME]; name the columns of each joint");
  const TomlTable all = diagnose_program::sub_table(root, {"joints", joints}, "tables of joints");
  for (const TomlEntry& entry : entries(all)) {
    read_joint(diagnose_program::sub_table(all, entry, "a table of columns"), entry.key, drive, setup);
  }
  if (setup.joints.empty())
    throw surefoot::DiagnoseError(file + ": [joints] is empty; name the columns of at least one joint");
  if (const toml::value* groups = find(root, "groups")) {
    read_groups(diagnose_program::sub_table(root, {"groups", groups}, "lists of joints"), setup);
  }
  for (const JointSetup& joint : setup.joints) {
    const bool placed = std::ranges::any_of(setup.groups, [&](const Group& group) {
      return std::ranges::find(group.joints, joint.name) != group.joints.end();
    });
    if (!placed) setup.groups.push_back({joint.name, {joint.name}});
  }
  return setup;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

std::string list_of(const std::vector<std::string>& names) {
  std::string result = "[";
  for (const std::string& name : names) result += (result.size() > 1 ? ", " : "") + quoted(name);
  return result + "]";
}

void write_column(std::ostringstream& text, const char* key, const ColumnOf& column) {
  if (column.name.empty()) return;
  text << key << " = ";
  const bool by_name = !diagnose_program::unit_of_column(column.name).empty() || column.factor == 1;
  if (by_name) {
    text << quoted(column.name) << '\n';
  } else {
    text << "{ column = " << quoted(column.name) << ", factor = " << column.factor << " }\n";
  }
}

}  // namespace

RobotSetup parse_setup(const std::string& text, const std::string& file) {
  return read_tables(diagnose_program::read_toml(text, file), file);
}

RobotSetup read_setup(const std::filesystem::path& file) {
  const surefoot::Bytes bytes = surefoot::read_file(file);
  if (bytes.size() > largest_file) throw surefoot::DiagnoseError(file.filename().string() + ": too large for a setup");
  return parse_setup({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.filename().string());
}

std::string setup_text(const RobotSetup& setup, const std::vector<std::string>& remarks) {
  std::ostringstream text;
  text.precision(10);
  text << "schema = \"surefoot.robot/1\"\n";
  for (const std::string& remark : remarks) text << "# " << remark << '\n';
  text << "time = " << quoted(setup.time) << '\n';
  if (setup.base_held) text << "base = \"held\"          # the floating base did not move\n";
  if (!setup.held.empty()) text << "held = " << list_of(setup.held) << "  # joints that did not move\n";
  std::vector<std::string> calibrate;
  if (setup.calibrate_gains) calibrate.push_back("gains");
  if (setup.calibrate_bodies) calibrate.push_back("bodies");
  text << "calibrate = " << list_of(calibrate) << "   # of \"gains\", \"bodies\"\n";
  text << "\n[drive]\nkind = " << (setup.drive == DriveKind::position ? "\"position\"" : "\"torque\"") << '\n';
  text << "\n[groups]                # joints with equal motors\n";
  for (const Group& group : setup.groups) text << quoted(group.name) << " = " << list_of(group.joints) << '\n';
  for (const JointSetup& joint : setup.joints) {
    text << "\n[joints." << quoted(joint.name) << "]\n";
    write_column(text, "goal", joint.goal);
    write_column(text, "torque", joint.torque);
    write_column(text, "angle", joint.angle);
    write_column(text, "speed", joint.speed);
    if (setup.drive == DriveKind::position) text << "kp = " << joint.kp << "\nkd = " << joint.kd << '\n';
    if (joint.limit > 0) text << "limit = " << joint.limit << '\n';
  }
  return text.str();
}

}  // namespace diagnose_robot
