#include "load_sequences.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "../diagnose/csv.hpp"
#include "../diagnose/names.hpp"
#include "surefoot/core/pose2.hpp"

namespace calibrate_program {
namespace {

using diagnose_program::Csv;
using diagnose_program::in_quotes;
using diagnose_program::listed;
using surefoot::MotionError;
using surefoot::Pose2;
using surefoot::WalkSequence;

constexpr double largest = 1e4;  // what no command and no pose of a walk exceeds [m, rad]

struct Rows {
  std::size_t from = 0, to = 0;
  std::size_t count() const { return to - from; }
};

[[noreturn]] void fail(const Csv& csv, std::size_t row, const std::string& what) {
  throw MotionError(csv.file + ", line " + std::to_string(csv.lines[row]) + ": " + what);
}

std::string rounded_text(double value) {
  std::string text = std::to_string(value);
  while (text.find('.') != std::string::npos && (text.back() == '0' || text.back() == '.')) {
    const bool point = text.back() == '.';
    text.pop_back();
    if (point) break;
  }
  return text;
}

bool has_column(const Csv& csv, const std::string& name) {
  return std::ranges::find(csv.columns, name, &diagnose_program::CsvColumn::name) != csv.columns.end();
}

double value_at(const Csv& csv, const std::vector<double>& column, const std::string& name, std::size_t row,
                const std::string& why) {
  if (std::isnan(column[row])) fail(csv, row, "column " + in_quotes(name) + " is empty; " + why);
  return column[row];
}

/// Stretches of rows with the same sequence number; each number stands in one stretch alone.
std::vector<Rows> stretches(const Csv& csv, bool many) {
  if (!many) return {{0, csv.rows()}};
  const std::vector<double>& number = numbers(csv, "seq", "which tells sequences apart");
  std::vector<Rows> result;
  std::set<double> seen;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const double value = value_at(csv, number, "seq", row, "every row needs the number of its sequence");
    if (row == 0 || value != number[row - 1]) {
      if (!seen.insert(value).second) {
        fail(csv, row, "sequence " + rounded_text(value) + " was already over; put the rows of a sequence together");
      }
      result.push_back({row, row});
    }
    result.back().to = row + 1;
  }
  return result;
}

void check_cycles(const Csv& csv, const Rows& rows) {
  if (!has_column(csv, "cycle")) return;
  const std::vector<double>& cycle = numbers(csv, "cycle", "which counts the cycles");
  for (std::size_t row = rows.from; row < rows.to; ++row) {
    value_at(csv, cycle, "cycle", row, "every row needs the number of its cycle");
    if (row > rows.from && cycle[row] != cycle[row - 1] + 1) {
      fail(csv, row,
           "cycle " + rounded_text(cycle[row]) + " follows cycle " + rounded_text(cycle[row - 1]) +
               ", but cycles count up by 1; sort the rows and complete the missing ones");
    }
  }
}

/// Column by column: x, y, turn [m, m, rad] of a whole cycle, row by row.
class CommandReader {
 public:
  CommandReader(const Csv& csv, const FileLayout& layout, const LoadOptions& options)
      : csv_(csv), layout_(layout), options_(options) {
    for (std::size_t i = 0; i < 3; ++i)
      columns_[i] = &numbers(csv, layout.columns.commands[i].name, "which holds commands");
  }

  surefoot::Vec<3> command(std::size_t row) const {
    const surefoot::Vec<3> read = options_.columns.wheels.empty() ? walk_command(row) : wheel_command(row);
    if (!(read.cwiseAbs().maxCoeff() <= largest)) {
      fail(csv_, row,
           "a command of more than " + rounded_text(largest) + " m or rad; check the numbers and their units");
    }
    return read;
  }

 private:
  double value(std::size_t i, std::size_t row) const {
    const Column& column = layout_.columns.commands[i];
    return column.factor * value_at(csv_, *columns_[i], column.name, row, "every cycle needs its command");
  }

  surefoot::Vec<3> walk_command(std::size_t row) const {
    return layout_.steps_per_cycle * surefoot::Vec<3>(value(0, row), value(1, row), value(2, row));
  }

  surefoot::Vec<3> wheel_command(std::size_t row) const {
    const double now = value(2, row), next = value(2, row + 1), left = value(0, row), right = value(1, row);
    if (!(next > now)) {
      fail(csv_, row + 1,
           "column 't_s' does not rise, " + rounded_text(next) + " follows " + rounded_text(now) +
               "; sort the rows by time and remove repeated ones");
    }
    return (next - now) * surefoot::Vec<3>((left + right) / 2, 0, (right - left) / options_.wheel_base);
  }

  const Csv& csv_;
  const FileLayout& layout_;
  const LoadOptions& options_;
  std::array<const std::vector<double>*, 3> columns_{};
};

/// x, y, heading [m, m, rad] by column of the result, one for each row; NaN where not measured.
Eigen::Matrix3Xd read_poses(const Csv& csv, const Columns& columns, const Rows& rows) {
  Eigen::Matrix3Xd poses = Eigen::Matrix3Xd::Constant(3, static_cast<Eigen::Index>(rows.count()), std::nan(""));
  for (std::size_t i = 0; i < 3; ++i) {
    if (!columns.pose[i]) continue;
    const std::vector<double>& column = numbers(csv, columns.pose[i]->name, "which holds poses");
    for (std::size_t row = rows.from; row < rows.to; ++row) {
      const double value = columns.pose[i]->factor * column[row];
      if (std::abs(value) > largest) {
        fail(csv, row,
             "column " + in_quotes(columns.pose[i]->name) + " holds more than " + rounded_text(largest) +
                 " m or rad; check the numbers and their units");
      }
      poses(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(row - rows.from)) = value;
    }
  }
  return poses;
}

/// Poses seen from the first one. A recording whose first pose is empty starts at the origin.
Eigen::Matrix3Xd seen_from_start(const Csv& csv, const Rows& rows, const Eigen::Matrix3Xd& poses, bool& measured) {
  const surefoot::Vec<3> first = poses.col(0);
  measured = first.array().isFinite().any();
  if (!measured) return poses.rightCols(poses.cols() - 1);
  if (!first.allFinite()) {
    fail(csv, rows.from, "the first row holds part of a pose; give x, y and heading of the start, or none of them");
  }
  Eigen::Matrix3Xd seen = poses.rightCols(poses.cols() - 1);
  const Pose2 from = Pose2::from_vec(first).inverse();
  for (auto pose : seen.colwise()) {
    const surefoot::Vec<2> position = from.transform(pose.head<2>());  // NaN where either is
    const double turned = pose[2] - first[2];
    pose << position, std::isfinite(turned) ? surefoot::wrap_angle(turned) : turned;
  }
  return seen;
}

double steps_of(const Csv& csv, const LoadOptions& options) {
  const auto meta = csv.meta.find("steps_per_cycle");
  if (options.steps_per_cycle > 0) return options.steps_per_cycle;
  if (meta == csv.meta.end()) return options.usual_steps;
  const double value = diagnose_program::number_or_nan(meta->second);
  if (value > 0 && value <= 1000) return value;
  throw MotionError(csv.file +
                    ": the first line 'steps_per_cycle: " + diagnose_program::printable(meta->second.substr(0, 40)) +
                    "' must give a number above 0, at most 1000");
}

WalkSequence read_sequence(const Csv& csv, const Rows& rows, const CommandReader& commands, FileLayout& layout) {
  WalkSequence sequence;
  const Eigen::Matrix3Xd poses = read_poses(csv, layout.columns, rows);
  const std::size_t cycles = layout.many ? rows.count() : rows.count() - 1;
  sequence.commands.resize(3, static_cast<Eigen::Index>(cycles));
  for (std::size_t i = 0; i < cycles; ++i) {
    sequence.commands.col(static_cast<Eigen::Index>(i)) = commands.command(rows.from + i);
  }
  sequence.poses = layout.many ? poses : seen_from_start(csv, rows, poses, layout.measured_start);
  return sequence;
}

}  // namespace

LoadedSequences sequences_of(const Csv& csv, const LoadOptions& options) {
  LoadedSequences loaded;
  FileLayout& layout = loaded.layout;
  layout.many = has_column(csv, "seq") && options.columns.wheels.empty();
  layout.columns = recognise_columns(csv, options.columns, options.poses_needed);
  layout.steps_per_cycle = steps_of(csv, options);
  const std::size_t least = layout.many ? 1 : 2;
  if (csv.rows() < least) {
    throw MotionError(csv.file + ": only " + std::to_string(csv.rows()) + " row(s) of numbers, but at least " +
                      std::to_string(least) + " are needed");
  }
  const CommandReader commands(csv, layout, options);
  for (const Rows& rows : stretches(csv, layout.many)) {
    check_cycles(csv, rows);
    WalkSequence sequence = read_sequence(csv, rows, commands, layout);
    sequence.name = csv.file;
    if (layout.many) sequence.name = rounded_text(numbers(csv, "seq", "")[rows.from]) + " of " + csv.file;
    if (!options.columns.wheels.empty()) {
      const std::vector<double>& time = numbers(csv, "t_s", "");
      layout.period = (time[rows.to - 1] - time[rows.from]) / static_cast<double>(rows.count() - 1);
    }
    if (options.final_only) sequence = final_pose_only(std::move(sequence));
    if (options.poses_needed && !sequence.position_measured(sequence.cycles() - 1)) {
      loaded.skipped.push_back(sequence.name);
    } else {
      loaded.sequences.push_back(std::move(sequence));
    }
  }
  return loaded;
}

LoadedSequences load_sequences(const std::vector<std::filesystem::path>& files, const LoadOptions& options) {
  LoadedSequences all;
  for (const std::filesystem::path& file : files) {
    LoadedSequences one = sequences_of(diagnose_program::read_csv(file), options);
    if (&file == &files.front()) all.layout = one.layout;
    if (one.layout.steps_per_cycle != all.layout.steps_per_cycle) {
      throw MotionError(file.filename().string() + ": has " + rounded_text(one.layout.steps_per_cycle) +
                        " steps per cycle, but " + files.front().filename().string() + " has " +
                        rounded_text(all.layout.steps_per_cycle) + "; calibrate them one by one");
    }
    std::ranges::move(one.sequences, std::back_inserter(all.sequences));
    std::ranges::move(one.skipped, std::back_inserter(all.skipped));
  }
  if (all.sequences.empty()) {
    throw MotionError(files.front().filename().string() + (files.size() > 1 ? " and the others: " : ": ") +
                      "no sequence has a final position; measure where the robot stopped and fill it in");
  }
  return all;
}

std::string skipped_sentence(const LoadedSequences& loaded) {
  if (loaded.skipped.empty()) return {};
  return std::to_string(loaded.skipped.size()) + " of " +
         std::to_string(loaded.skipped.size() + loaded.sequences.size()) +
         " sequences have no final position and are left out: " + listed(loaded.skipped, 6);
}

}  // namespace calibrate_program
