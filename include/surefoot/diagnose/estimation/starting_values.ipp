// Definitions of surefoot/diagnose/estimation/starting_values.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/hypothesis.hpp"
#include "surefoot/diagnose/estimation/starting_values.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE double peak_at(const BoundSimulator& bound, const AttachedEffect& attached) {
  const auto at = static_cast<std::size_t>(attached.at);
  const std::size_t inputs = bound.info.inputs.size();
  double peak = 1;
  if (attached.effect->place == Place::velocity) {
    const int position = bound.structure.position_of[at];
    peak = bound.sizes.state_peak[position >= 0 ? static_cast<std::size_t>(position) : at];
  } else if (attached.effect->place == Place::state) {
    peak = bound.sizes.state_peak[at];
  } else if (attached.effect->place == Place::input) {
    peak = at < inputs ? std::max(-bound.sizes.input_low[at], bound.sizes.input_high[at])
                       : bound.sizes.signal_peak[at - inputs];
  }
  return peak > 0 ? peak : 1;
}

/// The least absolute value of an input other than 0; 0 of what is none, and where all values are alike.
SUREFOOT_ONCE double least_at(const BoundSimulator& bound, const AttachedEffect& attached) {
  if (attached.effect->place != Place::input) return 0;
  const double least = bound.sizes.least[static_cast<std::size_t>(attached.at)];
  return least < peak_at(bound, attached) ? least : 0;
}

SUREFOOT_ONCE int output_watching(const BoundSimulator& bound, const AttachedEffect& attached) {
  const auto at = static_cast<std::size_t>(attached.at);
  switch (attached.effect->place) {
    case Place::output:
      return attached.at;
    case Place::state:
      return bound.structure.output_of[at];
    case Place::velocity:
      return bound.structure.position_of[at] < 0
                 ? -1
                 : bound.structure.output_of[static_cast<std::size_t>(bound.structure.position_of[at])];
    default:
      return -1;
  }
}

SUREFOOT_ONCE std::vector<Observed> observe(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                            const std::vector<SimulatedRun>& runs) {
  std::vector<Observed> result(bound.info.outputs.size());
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const Eigen::MatrixXd& outputs = bound.recordings[recordings[i]].outputs;
    for (Eigen::Index k = 0; k < outputs.rows(); ++k) {
      for (Eigen::Index row = 0; row < outputs.cols(); ++row) {
        if (!std::isfinite(outputs(k, row))) continue;
        result[static_cast<std::size_t>(k)].readings.push_back(outputs(k, row));
        result[static_cast<std::size_t>(k)].simulated.push_back(runs[i].outputs(k, row));
      }
    }
  }
  return result;
}

/// Readings of what an effect is attached to, in its unit.
SUREFOOT_ONCE Observed in_unit_of(const BoundSimulator& bound, const AttachedEffect& attached, Observed seen) {
  const Place place = attached.effect->place;
  if (place != Place::state && place != Place::velocity) return seen;
  const auto at = static_cast<std::size_t>(attached.at);
  const int state = place == Place::state ? attached.at : bound.structure.position_of[at];
  const StateReading way = reading_of(bound.structure, static_cast<std::size_t>(state));
  for (double& value : seen.readings) value = way.state_at(value);
  for (double& value : seen.simulated) value = way.state_at(value);
  return seen;
}

SUREFOOT_ONCE std::vector<Eigen::VectorXd> starting_values(const BoundSimulator& bound,
                                                           const AttachedEffect& attached,
                                                           const std::vector<Observed>& observed) {
  const auto& parameters = attached.effect->parameters;
  std::vector<Eigen::VectorXd> result{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters.size()))};
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double unit =
        parameters[k].of_peak ? peak_at(bound, attached) : measure_size(bound, attached, parameters[k].measure);
    const double least = parameters[k].beyond_least ? least_at(bound, attached) : 0;
    std::vector<Eigen::VectorXd> longer;
    for (const Eigen::VectorXd& one : result) {
      for (const double start : parameters[k].starts) {
        longer.push_back(one);
        longer.back()[static_cast<Eigen::Index>(k)] = least + start * std::max(0.0, unit - least);
      }
    }
    result = std::move(longer);
  }
  const int output = output_watching(bound, attached);
  std::vector<double> suggested;
  if (attached.effect->suggest && output >= 0 && !observed.empty()) {
    const Observed seen = in_unit_of(bound, attached, observed[static_cast<std::size_t>(output)]);
    suggested = attached.effect->suggest(seen.readings, seen.simulated);
  }
  if (suggested.empty()) return attached.effect->needs_suggestion ? std::vector<Eigen::VectorXd>{} : result;
  std::vector<Eigen::VectorXd> better;
  for (const Eigen::VectorXd& one : result) {
    if (one[0] != result.front()[0]) continue;  // each combination of the other parameters once
    for (const double value : suggested) {
      better.push_back(one);
      better.back()[0] = value;
    }
  }
  return better;
}

}  // namespace surefoot::diagnosis
