// Definitions of surefoot/diagnose/screening.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/screening.hpp"
#include "surefoot/diagnose/simulator.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot {

SUREFOOT_ONCE void check_recording(const SimulatorInfo& info, const Recording& recording) {
  const auto fail = [&](const std::string& what) { throw DiagnoseError(recording.name + ": " + what); };
  if (recording.rows() < 2) fail("needs at least two rows, has " + std::to_string(recording.rows()));
  if (recording.inputs.rows() != static_cast<Eigen::Index>(info.inputs.size()) ||
      (recording.inputs.rows() > 0 && recording.inputs.cols() != recording.rows())) {
    fail("inputs must have one row per input of the model and one column per time");
  }
  if (recording.outputs.rows() != static_cast<Eigen::Index>(info.outputs.size()) ||
      recording.outputs.cols() != recording.rows()) {
    fail("outputs must have one row per output of the model and one column per time");
  }
  const auto states = static_cast<Eigen::Index>(info.states.size());
  if (recording.initial.size() != states || recording.initial_scale.size() != states ||
      !all_finite(recording.initial)) {
    fail("the initial state must have one finite value, and one scale, per state of the model");
  }
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {
    for (Eigen::Index i = 0; i < recording.inputs.rows(); ++i) {
      if (!std::isfinite(recording.inputs(i, row))) {
        fail("input '" + info.inputs[static_cast<std::size_t>(i)].name + "' has no value in row " +
             std::to_string(row) + "; inputs must be known throughout");
      }
    }
    if (row > 0 && !(recording.time[row] > recording.time[row - 1])) {
      fail("time does not rise at row " + std::to_string(row));
    }
  }
  const double* const values = recording.outputs.data();
  if (std::none_of(values, values + recording.outputs.size(), [](double value) { return std::isfinite(value); })) {
    fail("no output was ever measured");
  }
}

/// Whether any output takes two values.
SUREFOOT_ONCE bool any_output_changes(const std::vector<Recording>& recordings) {
  for (Eigen::Index k = 0; k < recordings.front().outputs.rows(); ++k) {
    double first = std::numeric_limits<double>::quiet_NaN();
    for (const Recording& recording : recordings) {
      for (const double value : detail::row_of(recording.outputs, k)) {
        if (std::isfinite(value) && std::isfinite(first) && value != first) return true;
        if (!std::isfinite(first)) first = value;
      }
    }
  }
  return false;
}

SUREFOOT_ONCE void check_readings(const SimulatorInfo& info, const std::vector<Recording>& recordings) {
  constexpr std::size_t enough = 3;  // readings for each unknown
  if (!recordings.empty() && !any_output_changes(recordings)) {
    throw DiagnoseError(
        "no output changes in any recording: see that the sensors are connected, and their columns the right ones");
  }
  std::size_t unknowns = 0, readings = 0;
  for (const ParameterInfo& parameter : info.parameters) unknowns += parameter.fixed ? 0 : 1;
  for (const Recording& recording : recordings) {
    for (const double scale : recording.initial_scale) unknowns += scale > 0 ? 1 : 0;
    const Eigen::Index first = recording.outputs.rows();  // cells of the first row, which says where it starts
    for (Eigen::Index i = first; i < recording.outputs.size(); ++i) {
      readings += std::isfinite(recording.outputs.data()[i]) ? 1 : 0;
    }
  }
  if (readings >= enough * std::max<std::size_t>(1, unknowns)) return;
  throw DiagnoseError("the recordings hold " + std::to_string(readings) +
                      " readings after their first rows, too few to tell " + std::to_string(unknowns) +
                      " parameters and initial states; record at least " +
                      std::to_string(enough * std::max<std::size_t>(1, unknowns)));
}

SUREFOOT_ONCE std::vector<Remark> remove_outliers(const SimulatorInfo& info, Recording& recording,
                                                  const Eigen::MatrixXd& simulated) {
  constexpr double far = 8;  // times what 95 % of the readings do, and what the sensor resolves
  std::vector<Remark> remarks;
  for (Eigen::Index k = 0; k < recording.outputs.rows(); ++k) {
    const Eigen::VectorXd readings = detail::row_of(recording.outputs, k);
    Eigen::VectorXd y = readings;
    for (Eigen::Index i = 0; i < simulated.cols(); ++i) y[i] -= simulated(k, i);
    Eigen::VectorXd bend = Eigen::VectorXd::Zero(y.size());  // at each reading
    std::vector<double> bends;
    for (Eigen::Index i = 1; i + 1 < y.size(); ++i) {
      bend[i] = std::abs(y[i] - 0.5 * (y[i - 1] + y[i + 1]));
      if (std::isfinite(bend[i])) bends.push_back(bend[i]);
    }
    if (bends.size() < 30) continue;
    const auto high = bends.begin() + static_cast<std::ptrdiff_t>(bends.size() * 19 / 20);
    std::nth_element(bends.begin(), high, bends.end());
    double resolution = std::numeric_limits<double>::infinity();  // of the sensor: the smallest change
    for (Eigen::Index i = 1; i < y.size(); ++i) {
      const double change = std::abs(readings[i] - readings[i - 1]);
      if (change > 0) resolution = std::min(resolution, change);
    }
    const double limit = far * std::max(*high, resolution);
    for (Eigen::Index i = 1; i + 1 < y.size(); ++i) {
      if (!(bend[i] > limit) || std::abs(y[i + 1] - y[i - 1]) > 0.5 * bend[i]) continue;
      if (bend[i - 1] > bend[i] || bend[i + 1] > bend[i]) continue;  // it is the other one that is off
      const double before = readings[i] - readings[i - 1], after = readings[i] - readings[i + 1];
      if (std::abs(before + after) < bend[i]) continue;  // it is the simulation that jumps
      if (!(before * after > 0)) continue;  // between its neighbours: a bend, as where friction stops a motion
      recording.outputs(k, i) = std::numeric_limits<double>::quiet_NaN();
      char text[200];
      std::snprintf(text, sizeof text, "one outlier of %s at time %.4g (%.4g between %.4g and %.4g) was taken out",
                    info.outputs[static_cast<std::size_t>(k)].name.c_str(), recording.time[i], readings[i],
                    readings[i - 1], readings[i + 1]);
      remarks.push_back({recording.name, text});
    }
  }
  return remarks;
}

SUREFOOT_ONCE std::vector<Remark> screen(const SimulatorInfo& info, const std::vector<Recording>& recordings) {
  std::vector<Remark> remarks;
  for (std::size_t i = 0; i < info.inputs.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    double low = std::numeric_limits<double>::infinity(), high = -low, least = low;  // the least but for zeros
    for (const Recording& recording : recordings) {
      for (const double value : detail::row_of(recording.inputs, k)) {
        low = std::min(low, value);
        high = std::max(high, value);
        if (value != 0) least = std::min(least, value);
      }
    }
    const bool switched = low == 0 && least == high;  // has no other side
    if (!(high > low)) {
      remarks.push_back({"", "input " + info.inputs[i].name +
                                 " never changes: nothing on its path (gain, delay, dead zone) can be told"});
    } else if (!switched && (low >= 0 || high <= 0)) {
      remarks.push_back({"", "input " + info.inputs[i].name +
                                 " never changes its sign: what differs between both sides cannot be seen"});
    }
  }
  for (std::size_t i = 0; i < info.outputs.size(); ++i) {
    for (const Recording& recording : recordings) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      Eigen::Index count = 0;
      const Eigen::VectorXd y = detail::row_of(recording.outputs, static_cast<Eigen::Index>(i));
      for (const double value : y) {
        if (!std::isfinite(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
        ++count;
      }
      if (count > 2 && !(high > low)) {
        remarks.push_back({recording.name, "output " + info.outputs[i].name + " never changes"});
      }
    }
  }
  return remarks;
}

}  // namespace surefoot
