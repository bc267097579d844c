#include "joint_log.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "../common/usage_error.hpp"
#include "../diagnose/csv.hpp"

namespace calibrate_program {
namespace {

using diagnose_program::Csv;
using diagnose_program::CsvColumn;

constexpr double block_s = 5;            // several walk cycles, so that blocks differ little [s]
constexpr double longest_gap_s = 0.1;    // between rows of a block [s]
constexpr std::size_t fewest_rows = 50;  // in a block

const std::vector<double>* column(const Csv& csv, const std::string& name) {
  const auto found = std::ranges::find(csv.columns, name, &CsvColumn::name);
  return found == csv.columns.end() ? nullptr : &found->values;
}

std::vector<std::string> joints_of(const Csv& csv) {
  constexpr std::string_view before = "goal_", after = "_rad";
  std::vector<std::string> joints;
  for (const CsvColumn& one : csv.columns) {
    if (!one.name.starts_with(before) || !one.name.ends_with(after)) continue;
    const std::string name = one.name.substr(before.size(), one.name.size() - before.size() - after.size());
    if (column(csv, "position_" + name + "_rad") != nullptr) joints.push_back(name);
  }
  return joints;
}

/// From the first row of each block to behind its last one.
std::vector<std::pair<std::size_t, std::size_t>> blocks_of(const std::vector<double>& time,
                                                           const std::vector<double>* enabled) {
  std::vector<std::pair<std::size_t, std::size_t>> blocks;
  std::size_t begin = 0;
  const auto walks = [&](std::size_t i) { return enabled == nullptr || (*enabled)[i] > 0; };
  const auto close = [&](std::size_t end) {
    if (end - begin >= fewest_rows && time[end - 1] - time[begin] > block_s / 2) blocks.emplace_back(begin, end);
    begin = end;
  };
  for (std::size_t i = 0; i < time.size(); ++i) {
    const bool goes_on = i > begin && time[i] > time[i - 1] && time[i] - time[i - 1] < longest_gap_s;
    if (i > begin && (!goes_on || !walks(i) || time[i] - time[begin] > block_s)) close(i);
    if (!walks(i)) begin = i + 1;
  }
  if (begin < time.size()) close(time.size());
  return blocks;
}

/// Null where none was logged.
const std::vector<double>* currents_of(const Csv& csv, const std::string& joint) {
  const std::vector<double>* current = column(csv, "current_" + joint + "_A");
  const auto known = [](double value) { return std::isfinite(value); };
  return current != nullptr && std::ranges::any_of(*current, known) ? current : nullptr;
}

/// Rows without a goal or an angle are left out.
JointBlock cut(const Csv& csv, const std::string& joint, const std::vector<double>& time, std::size_t begin,
               std::size_t end) {
  const std::vector<double>&goal = *column(csv, "goal_" + joint + "_rad"),
        &angle = *column(csv, "position_" + joint + "_rad");
  const std::vector<double>* current = currents_of(csv, joint);
  JointBlock block;
  for (std::size_t i = begin; i < end; ++i) {
    if (!std::isfinite(goal[i] + angle[i]) || (current != nullptr && !std::isfinite((*current)[i]))) continue;
    block.time.push_back(time[i]);
    block.goal.push_back(goal[i]);
    block.angle.push_back(angle[i]);
    if (current != nullptr) block.current.push_back((*current)[i]);
  }
  return block;
}

}  // namespace

JointLog read_joint_logs(const std::vector<std::filesystem::path>& files) {
  JointLog log;
  for (const std::filesystem::path& file : files) {
    const auto fail = [&](const std::string& what) { throw example::UsageError(file.string() + ": " + what); };
    const Csv csv = diagnose_program::read_csv(file);
    const std::vector<double>* time = column(csv, "t_s");
    const std::vector<std::string> joints = joints_of(csv);
    if (time == nullptr || joints.empty())
      fail("is no log of joints: it needs t_s, goal_NAME_rad and position_NAME_rad");
    if (!log.joints.empty() && joints != log.joints) fail("has other joints than the files before it");
    log.joints = joints;
    log.blocks.resize(joints.size());
    for (const auto& [begin, end] : blocks_of(*time, column(csv, "enabled_1"))) {
      for (std::size_t j = 0; j < joints.size(); ++j) {
        JointBlock block = cut(csv, joints[j], *time, begin, end);
        if (block.time.size() >= fewest_rows) log.blocks[j].push_back(std::move(block));
      }
    }
  }
  for (std::size_t j = 0; j < log.joints.size(); ++j) {
    if (log.blocks[j].size() < 2) {
      throw example::UsageError(files.front().string() + ": has less than two blocks of 5 s of walking of joint " +
                                log.joints[j] + "; log a longer walk");
    }
  }
  return log;
}

}  // namespace calibrate_program
