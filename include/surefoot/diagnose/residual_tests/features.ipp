// Definitions of surefoot/diagnose/residual_tests/features.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/residual_tests/features.hpp"

namespace surefoot::diagnosis {

/// Whether what an input does until a row is that of the row before.
SUREFOOT_ONCE bool is_of_row_before(const BoundSimulator& bound, std::size_t input, InputsOf inputs) {
  const bool acts_before = bound.info.inputs[input].hold == InputHold::before;
  return inputs == InputsOf::row_before && !acts_before && !bound.structure.shown_at_once[input];
}

SUREFOOT_ONCE std::vector<std::string> feature_names(const BoundSimulator& bound, InputsOf inputs) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < bound.info.states.size(); ++i) {
    names.push_back(bound.info.states[i].name);
    if (!bound.structure.velocity[i]) continue;
    names.push_back("abs(" + bound.info.states[i].name + ")");
    names.push_back("since_reversal(" + bound.info.states[i].name + ")");
  }
  for (std::size_t k = 0; k < bound.info.inputs.size(); ++k) {
    const std::string& input = bound.info.inputs[k].name;
    names.push_back(is_of_row_before(bound, k, inputs) ? "last(" + input + ")" : input);
    names.push_back("since_change(" + names.back() + ")");
  }
  names.emplace_back("time");
  if (bound.info.kind == SimulatorKind::map) {
    for (int period = 2; period <= longest_gait; ++period) names.push_back("step_modulo_" + std::to_string(period));
  }
  for (const auto& [key, first] : bound.recordings.front().constants) {
    bool differs = false;
    for (const Recording& recording : bound.recordings) {
      const auto found = recording.constants.find(key);
      differs = differs || found == recording.constants.end() || found->second != first;
    }
    if (differs) names.push_back(key);
  }
  return names;
}

SUREFOOT_ONCE FeatureTable make_features(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                         const std::vector<SimulatedRun>& trajectories, Eigen::Index stride,
                                         InputsOf inputs) {
  FeatureTable table;
  table.names = feature_names(bound, inputs);
  const auto row_of_input = [&](std::size_t k, Eigen::Index row) {
    return is_of_row_before(bound, k, inputs) ? std::max<Eigen::Index>(row - 1, 0) : row;
  };
  std::vector<std::vector<double>> rows;
  const auto n = bound.info.states.size(), m = bound.info.inputs.size();
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const Recording& recording = bound.recordings[recordings[i]];
    const Eigen::MatrixXd& states = trajectories[i].states;
    std::vector<double> reversed(n, recording.time[0]), changed(m, recording.time[0]);
    for (Eigen::Index row = 0; row < recording.rows(); ++row) {
      const double now = recording.time[row];
      for (std::size_t k = 0; row > 0 && k < n; ++k) {
        const auto s = static_cast<Eigen::Index>(k);
        if (states(s, row) * states(s, row - 1) < 0) reversed[k] = now;
      }
      for (std::size_t k = 0; row > 0 && k < m; ++k) {
        const auto s = static_cast<Eigen::Index>(k);
        const Eigen::Index at = row_of_input(k, row);
        if (recording.inputs(s, at) != recording.inputs(s, row_of_input(k, row - 1))) changed[k] = recording.time[at];
      }
      if (row % stride != 0) continue;
      std::vector<double> one;
      for (std::size_t k = 0; k < n; ++k) {
        const double value = states(static_cast<Eigen::Index>(k), row);
        one.push_back(value);
        if (!bound.structure.velocity[k]) continue;
        one.push_back(std::abs(value));
        one.push_back(now - reversed[k]);
      }
      for (std::size_t k = 0; k < m; ++k) {
        one.push_back(recording.inputs(static_cast<Eigen::Index>(k), row_of_input(k, row)));
        one.push_back(now - changed[k]);
      }
      one.push_back(now - recording.time[0]);
      if (bound.info.kind == SimulatorKind::map) {
        for (int period = 2; period <= longest_gait; ++period) one.push_back(static_cast<double>(row % period));
      }
      for (std::size_t k = one.size(); k < table.names.size(); ++k) {
        const auto found = recording.constants.find(table.names[k]);
        one.push_back(found == recording.constants.end() ? 0 : found->second);
      }
      rows.push_back(std::move(one));
      table.recording.push_back(i);
      table.row.push_back(row);
    }
  }
  table.values.resize(static_cast<Eigen::Index>(table.names.size()), static_cast<Eigen::Index>(rows.size()));
  for (std::size_t j = 0; j < rows.size(); ++j) {
    for (std::size_t k = 0; k < rows[j].size(); ++k) {
      const double value = rows[j][k];
      table.values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) = std::isfinite(value) ? value : 0;
    }
  }
  return table;
}

SUREFOOT_ONCE FeatureTable only_states(const BoundSimulator& bound, const FeatureTable& all) {
  FeatureTable table{.names = {}, .values = {}, .recording = all.recording, .row = all.row};
  std::vector<Eigen::Index> kept;
  for (const StateInfo& state : bound.info.states) {
    const auto found = std::find(all.names.begin(), all.names.end(), state.name);
    kept.push_back(found - all.names.begin());
    table.names.push_back(state.name);
  }
  table.values.resize(static_cast<Eigen::Index>(kept.size()), all.values.cols());
  for (Eigen::Index j = 0; j < table.values.cols(); ++j) {
    for (Eigen::Index k = 0; k < table.values.rows(); ++k) {
      table.values(k, j) = all.values(kept[static_cast<std::size_t>(k)], j);
    }
  }
  return table;
}

}  // namespace surefoot::diagnosis
