// `sheet`: a sheet that was filled in becomes recordings.
#include "sheet.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <numbers>
#include <optional>

#include "../common/files.hpp"
#include "../diagnose/names.hpp"
#include "commands.hpp"
#include "load_sequences.hpp"
#include "surefoot/core/pose2.hpp"
#include "walk_csv.hpp"

namespace calibrate_program {
namespace {

using diagnose_program::Csv;
using diagnose_program::CsvColumn;
using surefoot::MotionError;

struct Cells {
  const std::vector<double>* values;
  std::string name;
};

/// The column that is called `base`_UNIT for one of the units.
std::optional<Cells> find_column(const Csv& csv, const std::string& base, const std::vector<std::string>& units) {
  for (const std::string& unit : units) {
    const std::string name = base + "_" + unit;
    if (std::ranges::find(csv.columns, name, &CsvColumn::name) == csv.columns.end()) continue;
    return Cells{&numbers(csv, name, "which was measured"), name};
  }
  return std::nullopt;
}

Cells position_column(const Csv& csv, const std::string& base) {
  const auto found = find_column(csv, base, {"m", "cm", "mm"});
  if (found) return *found;
  std::vector<std::string> names;
  for (const CsvColumn& column : csv.columns) names.push_back(column.name);
  throw MotionError(csv.file + ": there is no column '" + base + "_cm' or '" + base + "_m', the file has " +
                    diagnose_program::listed(names));
}

double heading_of(const Csv& csv, std::size_t row, const Cells& cells) {
  const double value = (*cells.values)[row];
  if (!cells.name.ends_with("_clock") || std::isnan(value)) return *angle_factor(cells.name) * value;
  if (value < 0 || value > 12) {
    throw MotionError(csv.file + ", line " + std::to_string(csv.lines[row]) + ": column '" + cells.name + "' holds " +
                      number_text(value) + "; an hour from 1 to 12 is expected");
  }
  return surefoot::wrap_angle(-value * std::numbers::pi / 6);
}

/// Poses by the number of their sequence [m, m, rad].
std::map<double, surefoot::Vec<3>> poses_of(const Csv& sheet, const std::map<double, std::size_t>& known) {
  const std::vector<double>& number = numbers(sheet, "seq", "which tells sequences apart");
  const Cells x = position_column(sheet, "x"), y = position_column(sheet, "y");
  auto heading = find_column(sheet, "heading", {"clock", "deg", "rad"});
  if (!heading) heading = find_column(sheet, "theta", {"deg", "rad"});
  std::map<double, surefoot::Vec<3>> poses;
  for (std::size_t row = 0; row < sheet.rows(); ++row) {
    const auto fail = [&](const std::string& what) {
      throw MotionError(sheet.file + ", line " + std::to_string(sheet.lines[row]) + ": " + what);
    };
    const std::string name = "sequence " + number_text(number[row]);
    if (!known.contains(number[row])) fail(name + " is not among the commands; copy its number from there");
    const double x_here = *length_factor(x.name) * (*x.values)[row], y_here = *length_factor(y.name) * (*y.values)[row];
    if (std::isnan(x_here) != std::isnan(y_here)) fail(name + " has only one of x and y; fill in both or none");
    const surefoot::Vec<3> pose(x_here, y_here, heading ? heading_of(sheet, row, *heading) : std::nan(""));
    if (!poses.emplace(number[row], pose).second) fail(name + " stands twice in the sheet; remove one of its rows");
  }
  return poses;
}

}  // namespace

MergedSheet merge_sheet(const Csv& commands, const Csv& sheet) {
  LoadOptions options;
  options.poses_needed = false;
  const FileLayout layout = sequences_of(commands, options).layout;  // throws if the commands are no good
  if (!layout.many)
    throw MotionError(commands.file + ": column 'seq' is missing; give the commands.csv that `plan` wrote");
  const std::vector<double>& number = numbers(commands, "seq", "");
  std::map<double, std::size_t> last_row;
  for (std::size_t row = 0; row < commands.rows(); ++row) last_row[number[row]] = row;
  const auto poses = poses_of(sheet, last_row);
  MergedSheet merged;
  for (const auto& [key, text] : commands.meta) merged.walks += "# " + key + ": " + text + "\n";
  merged.walks += "seq,cycle";
  for (const Column& column : layout.columns.commands) merged.walks += "," + column.name;
  merged.walks += ",x_m,y_m,theta_rad\n";
  int cycle = 0;
  for (std::size_t row = 0; row < commands.rows(); ++row) {
    cycle = row > 0 && number[row] == number[row - 1] ? cycle + 1 : 0;
    const auto pose = poses.find(number[row]);
    const bool measured = pose != poses.end() && std::isfinite(pose->second[0]);
    const bool last = last_row[number[row]] == row;
    if (last) ++(measured ? merged.sequences : merged.skipped);
    if (!measured) continue;
    merged.walks += number_text(number[row]) + "," + std::to_string(cycle);
    for (const Column& column : layout.columns.commands) {
      merged.walks += "," + number_text(numbers(commands, column.name, "")[row]);
    }
    for (const double value : pose->second)
      merged.walks += "," + (last ? number_text(std::round(1e6 * value) / 1e6) : std::string());
    merged.walks += "\n";
  }
  if (merged.sequences == 0) {
    throw MotionError(sheet.file + ": no sequence has a position; fill in x and y where the robot ended");
  }
  return merged;
}

namespace {

struct SheetOptions {
  std::filesystem::path commands, sheet, out;
};

void run(const SheetOptions& options) {
  const MergedSheet merged =
      merge_sheet(diagnose_program::read_csv(options.commands), diagnose_program::read_csv(options.sheet));
  if (merged.skipped > 0) {
    std::cerr << "warning: " << merged.skipped << " of " << merged.skipped + merged.sequences
              << " sequences have no position in the sheet and are left out\n";
  }
  example::write_text(options.out, merged.walks);
  std::printf("%s: %zu sequences, for `surefoot-calibrate fit`\n", options.out.c_str(), merged.sequences);
}

}  // namespace

void add_sheet(example::Command& program) {
  auto options = std::make_shared<SheetOptions>();
  example::Command* command = program.add_subcommand("sheet", "Turn a sheet that was filled in into recordings");
  command->add_option("--commands,--orders", options->commands, "commands.csv of the plan")->required();
  command
      ->add_option("--sheet", options->sheet,
                   "sheet.csv, filled in: seq, x_cm, y_cm (or x_m, y_m), heading_clock (or heading_deg, heading_rad)")
      ->required();
  command->add_option("--out", options->out, "CSV file to write")->required();
  command->callback([options] { run(*options); });
}

}  // namespace calibrate_program
