#include "joint_changes.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "../common/printed.hpp"
#include "../common/usage_error.hpp"

namespace calibrate_program {
namespace {

constexpr double certain = 4;           // standard errors: by chance in one of 100 comparisons of 60 figures
constexpr double slow_rad_per_s = 0.1;  // a joint that moves less tells nothing of friction and lag

/// What is read off, in this order.
struct Reading {
  std::string_view what, unit, more, less;
};
constexpr std::array<Reading, 5> readings{
    {{"offset behind its goal", "rad", "is pushed further", "is pushed less far"},
     {"friction", "rad", "has more friction", "has less friction"},
     {"lag", "s", "follows later, as one that is weaker", "follows earlier, as one that is stiffer"},
     {"mean current", "A", "draws more current to one side", "draws more current to the other side"},
     {"friction in its current", "A", "has more friction, by its current", "has less friction, by its current"}}};
using Features = std::array<double, readings.size()>;

double unknown() { return std::numeric_limits<double>::quiet_NaN(); }

/// Least squares of `values` by 1, the sign of the speed and the speed.
Eigen::Vector3d parts_of(const std::vector<double>& values, const std::vector<double>& speeds) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Eigen::Vector3d regressors(1, std::tanh(speeds[i] / slow_rad_per_s), speeds[i]);
    normal += regressors * regressors.transpose();
    right += values[i] * regressors;
  }
  return normal.ldlt().solve(right);
}

Features features_of(const JointBlock& block) {
  std::vector<double> speeds, errors, currents;
  double squares = 0;
  for (std::size_t i = 1; i + 1 < block.time.size(); ++i) {
    speeds.push_back((block.angle[i + 1] - block.angle[i - 1]) / (block.time[i + 1] - block.time[i - 1]));
    errors.push_back(block.goal[i] - block.angle[i]);
    if (!block.current.empty()) currents.push_back(block.current[i]);
    squares += speeds.back() * speeds.back();
  }
  Features result;
  result.fill(unknown());
  if (std::sqrt(squares / static_cast<double>(speeds.size())) < slow_rad_per_s) {
    result[0] = Eigen::Map<const Eigen::ArrayXd>(errors.data(), std::ssize(errors)).mean();
    if (!currents.empty()) result[3] = Eigen::Map<const Eigen::ArrayXd>(currents.data(), std::ssize(currents)).mean();
    return result;
  }
  const Eigen::Vector3d lag = parts_of(errors, speeds);
  std::copy_n(lag.data(), 3, result.begin());
  if (currents.empty()) return result;
  const Eigen::Vector3d drawn = parts_of(currents, speeds);
  std::copy_n(drawn.data(), 2, result.begin() + 3);
  return result;
}

/// Mean over blocks, and the variance of the mean.
std::array<double, 2> mean_of(const std::vector<Features>& blocks, std::size_t which) {
  double sum = 0, squares = 0, count = 0;
  for (const Features& block : blocks) {
    if (!std::isfinite(block[which])) continue;
    sum += block[which];
    squares += block[which] * block[which];
    ++count;
  }
  if (count < 2) return {unknown(), unknown()};
  const double mean = sum / count;
  return {mean, (squares / count - mean * mean) / (count - 1)};
}

std::vector<Features> features_of(const std::vector<JointBlock>& blocks) {
  std::vector<Features> result;
  for (const JointBlock& block : blocks) result.push_back(features_of(block));
  return result;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// What changed in single joints beyond what happened to most, and in most. Loads move from joint to joint when one of
/// them changes; therefore a joint stands out only beyond what the others changed by more than chance explains.
void find_changed(std::vector<JointChange> changes, JointComparison& result) {
  std::vector<double> differences, apart, errors;
  for (const JointChange& one : changes) {
    differences.push_back(one.difference());
    errors.push_back(one.standard_error);
  }
  const double usual = median(differences);
  for (const double difference : differences) apart.push_back(std::abs(difference - usual));
  constexpr std::size_t fewest = 3;  // joints, to speak of most
  const bool several = changes.size() >= fewest;
  std::vector<JointChange> moved;
  constexpr double of_median = 1.2533, of_deviation = 1.4826;  // for normal errors
  const double spread = of_deviation * median(apart), joints = static_cast<double>(changes.size());
  const double beyond_chance = std::sqrt(std::max(0.0, spread * spread - median(errors) * median(errors)));
  const double error = of_median * median(errors) / std::sqrt(joints);
  if (several && std::abs(usual) > certain * error && std::abs(usual) > spread) {
    result.common.push_back({"", changes.front().what, changes.front().unit, 0, usual, error});
  }
  for (const JointChange& one : changes) {
    const double width = std::hypot(one.standard_error, several ? beyond_chance : 0);
    if (std::abs(one.difference() - (several ? usual : 0)) > certain * width) result.changed.push_back(one);
    if (std::abs(one.difference()) > certain * one.standard_error) moved.push_back(one);
  }
  if (changes.front().what == readings[0].what && moved.size() >= fewest) result.shifted = moved;
  result.all.insert(result.all.end(), changes.begin(), changes.end());
}

const Reading& reading_named(std::string_view what) { return *std::ranges::find(readings, what, &Reading::what); }

/// "has more friction: friction by 0.0125 rad (0.0119 to 0.0131)"
std::string in_words(const JointChange& change) {
  const Reading& reading = reading_named(change.what);
  const double low = change.difference() - 1.96 * change.standard_error,
               high = change.difference() + 1.96 * change.standard_error;
  return example::printed("%s: %s by %.2g %s (%.2g to %.2g)",
                          std::string(change.difference() > 0 ? reading.more : reading.less).c_str(),
                          change.what.c_str(), change.difference(), change.unit.c_str(), low, high);
}

}  // namespace

JointComparison compare_joints(const JointLog& before, const JointLog& after) {
  if (before.joints != after.joints) throw example::UsageError("the old and the new log are of different joints");
  JointComparison result;
  const std::size_t joints = before.joints.size();
  std::vector<std::vector<Features>> old_features, new_features;
  for (std::size_t j = 0; j < joints; ++j) {
    old_features.push_back(features_of(before.blocks[j]));
    new_features.push_back(features_of(after.blocks[j]));
  }
  for (std::size_t which = 0; which < readings.size(); ++which) {
    std::vector<JointChange> changes;
    for (std::size_t j = 0; j < joints; ++j) {
      const auto then = mean_of(old_features[j], which), now = mean_of(new_features[j], which);
      if (!std::isfinite(then[0] + now[0])) continue;
      changes.push_back({before.joints[j], std::string(readings[which].what), std::string(readings[which].unit),
                         then[0], now[0], std::sqrt(then[1] + now[1])});
    }
    if (!changes.empty()) find_changed(std::move(changes), result);
  }
  std::ranges::stable_sort(result.changed, std::ranges::greater{},
                           [](const JointChange& one) { return std::abs(one.difference()) / one.standard_error; });
  return result;
}

std::string joint_report(const JointComparison& comparison) {
  std::string text = "\nJoints, by goals, angles and currents:\n";
  if (comparison.changed.empty() && comparison.common.empty())
    return text + "  none follows its goals in another way.\n";
  for (const JointChange& one : comparison.common) text += "  most joints: " + in_words(one) + "\n";
  if (!comparison.shifted.empty()) {
    text += "  loads have moved between joints (";
    for (const JointChange& one : comparison.shifted) {
      text += example::printed("%s%s %+.2g rad", &one == &comparison.shifted.front() ? "" : ", ", one.joint.c_str(),
                               one.difference());
    }
    text += "):\n  the zero of a joint, a load or a slope; their own angles do not tell these apart.\n";
  }
  for (const JointChange& one : comparison.changed) text += "  " + one.joint + ": " + in_words(one) + "\n";
  return text;
}

}  // namespace calibrate_program
