// Definitions of surefoot/diagnose/log_doctor/log_repair.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/log_doctor/log_repair.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::string name_of(LogFaultKind kind) {
  switch (kind) {
    case LogFaultKind::sign:
      return "sign_flipped";
    case LogFaultKind::degrees:
      return "angle_unit";
    case LogFaultKind::time_unit:
      return "time_unit";
    case LogFaultKind::swap:
      return "columns_swapped";
    case LogFaultKind::offset:
      return "clock_offset";
    case LogFaultKind::output_skew:
    case LogFaultKind::time_skew:
      return "clock_skew";
    case LogFaultKind::stuck:
      return "stuck_sensor";
    case LogFaultKind::clipped:
      return "clipped";
    case LogFaultKind::repeated:
    case LogFaultKind::gap:
    case LogFaultKind::jump:
      return "dropped_samples";
    case LogFaultKind::odd:
      break;
  }
  return "odd_recording";
}

SUREFOOT_ONCE const std::string& name_of(const SimulatorInfo& info, const Channel& channel) {
  const auto i = static_cast<std::size_t>(channel.index);
  return channel.input ? info.inputs[i].name : info.outputs[i].name;
}

SUREFOOT_ONCE const std::string& unit_of(const SimulatorInfo& info, const Channel& channel) {
  const auto i = static_cast<std::size_t>(channel.index);
  return channel.input ? info.inputs[i].unit : info.outputs[i].unit;
}

SUREFOOT_ONCE std::vector<LogRepair> column_repairs(const SimulatorInfo& info) {
  std::vector<Channel> channels;
  for (std::size_t k = 0; k < info.outputs.size(); ++k) channels.push_back({false, static_cast<Eigen::Index>(k)});
  for (std::size_t i = 0; i < info.inputs.size(); ++i) channels.push_back({true, static_cast<Eigen::Index>(i)});
  std::vector<LogRepair> repairs;
  constexpr double radians = std::numbers::pi / 180;  // of a degree
  for (std::size_t c = 0; c < channels.size(); ++c) {
    repairs.push_back({.kind = LogFaultKind::sign, .channel = channels[c], .amount = -1});
    const std::string& unit = unit_of(info, channels[c]);
    const bool in_radians = unit.starts_with("rad");
    if (in_radians || unit.starts_with("deg")) {
      const double factor = in_radians ? radians : 1 / radians;
      repairs.push_back({.kind = LogFaultKind::degrees, .channel = channels[c], .amount = factor});
    }
    for (std::size_t d = c + 1; d < channels.size(); ++d) {
      if (channels[d].input != channels[c].input && unit_of(info, channels[d]) != unit) continue;
      repairs.push_back({.kind = LogFaultKind::swap, .channel = channels[c], .other = channels[d]});
    }
  }
  return repairs;
}

/// Readings of a channel at other times, between those that were measured next to each other.
SUREFOOT_ONCE void resample_output(const Recording& recording, Eigen::Index k, const Eigen::VectorXd& times,
                                   Recording& result) {
  constexpr double next_to = 2.5;  // times the median distance of measured rows: so few are missing that all are smooth
  std::vector<Eigen::Index> measured;
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {
    if (std::isfinite(recording.outputs(k, row))) measured.push_back(row);
  }
  std::vector<double> distances;
  for (std::size_t i = 1; i < measured.size(); ++i) {
    distances.push_back(recording.time[measured[i]] - recording.time[measured[i - 1]]);
  }
  if (distances.empty()) return;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  const double most = next_to * *middle;
  std::size_t i = 0;
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {
    result.outputs(k, row) = std::numeric_limits<double>::quiet_NaN();
    if (row > 0 && !std::isfinite(recording.outputs(k, row))) continue;  // sparse outputs stay sparse
    const double t = times[row];
    while (i + 2 < measured.size() && recording.time[measured[i + 1]] < t) ++i;
    const double from = recording.time[measured[i]], to = recording.time[measured[i + 1]];
    if (t < from || t > to || to - from > most) continue;
    const double share = (t - from) / (to - from);
    result.outputs(k, row) =
        (1 - share) * recording.outputs(k, measured[i]) + share * recording.outputs(k, measured[i + 1]);
  }
}

/// Initial states that were read off an output follow it.
SUREFOOT_ONCE void reread_initial(const BoundSimulator& bound, const Recording& before, Recording& after) {
  for (std::size_t i = 0; i < bound.info.states.size(); ++i) {
    const auto state = static_cast<Eigen::Index>(i);
    const int output = bound.structure.output_of[i];
    const StateReading way = reading_of(bound.structure, i);
    if (output < 0 || before.initial[state] != way.state_at(before.outputs(output, 0))) continue;
    for (Eigen::Index row = 0; row < after.rows(); ++row) {
      if (!std::isfinite(after.outputs(output, row))) continue;
      after.initial[state] = way.state_at(after.outputs(output, row));
      break;
    }
  }
}

SUREFOOT_ONCE Recording repaired(const BoundSimulator& bound, const Recording& recording, const LogRepair& repair) {
  Recording result = recording;
  Eigen::MatrixXd& columns = repair.channel.input ? result.inputs : result.outputs;
  Eigen::MatrixXd& others = repair.other.input ? result.inputs : result.outputs;
  const Eigen::Index k = repair.channel.index;
  Eigen::VectorXd times = recording.time;
  const double start = recording.time[0];
  switch (repair.kind) {
    case LogFaultKind::sign:
    case LogFaultKind::degrees:
      for (Eigen::Index row = 0; row < columns.cols(); ++row) columns(k, row) *= repair.amount;
      break;
    case LogFaultKind::swap:
      for (Eigen::Index row = 0; row < columns.cols(); ++row) {
        std::swap(columns(k, row), others(repair.other.index, row));
        if (repair.other.input && !std::isfinite(others(repair.other.index, row))) return recording;  // was not read
      }
      break;
    case LogFaultKind::time_unit:
      for (double& t : result.time) t = start + (t - start) * repair.amount;
      break;
    case LogFaultKind::time_skew:
      for (double& t : result.time) t = start + (t - start) / (1 + repair.amount);
      break;
    case LogFaultKind::offset:
    case LogFaultKind::output_skew:
      for (double& t : times) {
        t = repair.kind == LogFaultKind::offset ? t + repair.amount : start + (t - start) * (1 + repair.amount);
      }
      for (Eigen::Index output = 0; output < result.outputs.rows(); ++output) {
        resample_output(recording, output, times, result);
      }
      break;
    case LogFaultKind::stuck:
    case LogFaultKind::clipped:
    case LogFaultKind::repeated:
      for (const auto& [from, to] : repair.rows) {
        for (Eigen::Index row = from; row < to; ++row) columns(k, row) = std::numeric_limits<double>::quiet_NaN();
      }
      return result;
    case LogFaultKind::gap:
    case LogFaultKind::jump:
    case LogFaultKind::odd:
      return result;
  }
  reread_initial(bound, recording, result);
  return result;
}

}  // namespace surefoot::diagnosis
