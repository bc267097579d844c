// Definitions of surefoot/diagnose/estimation/hypothesis.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/hypothesis.hpp"
#include "surefoot/diagnose/simulation/bound_simulator.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Hypothesis nominal_hypothesis(const BoundSimulator& bound) {
  Hypothesis nominal;
  nominal.parameters = nominal_parameters(bound.info);
  for (const Recording& recording : bound.recordings) nominal.initial.push_back(recording.initial);
  return nominal;
}

SUREFOOT_INLINE SimulatedRun simulate(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t recording,
                                      const Integration& integration) {
  return bound.simulate(bound, recording, hypothesis.parameters, {hypothesis.effects, hypothesis.values},
                        hypothesis.initial[recording], integration);
}

SUREFOOT_INLINE std::vector<SimulatedRun> simulate_all(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                       const std::vector<std::size_t>& recordings,
                                                       const Integration& integration, const Parallel& parallel) {
  std::vector<SimulatedRun> result(recordings.size());
  parallel(recordings.size(),
           [&](std::size_t i) { result[i] = simulate(bound, hypothesis, recordings[i], integration); });
  return result;
}

SUREFOOT_ONCE Hypothesis without_effect(const Hypothesis& whole, std::size_t effect) {
  Hypothesis rest = whole;
  rest.effects.erase(rest.effects.begin() + static_cast<std::ptrdiff_t>(effect));
  rest.values.erase(rest.values.begin() + static_cast<std::ptrdiff_t>(effect));
  return rest;
}

SUREFOOT_ONCE Hypothesis without_rounding(Hypothesis hypothesis) {
  for (std::size_t e = hypothesis.effects.size(); e-- > 0;) {
    if (hypothesis.effects[e].effect->rounds) hypothesis = without_effect(hypothesis, e);
  }
  return hypothesis;
}

SUREFOOT_ONCE Eigen::VectorXd values_before_starts(const Effect& effect, const Eigen::VectorXd& values,
                                                   std::size_t recordings) {
  const auto parameters = static_cast<Eigen::Index>(effect.parameters.size());
  const auto starts = static_cast<Eigen::Index>(effect.starts_anywhere ? recordings : 0);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(parameters + starts);
  for (Eigen::Index k = 0; k < parameters; ++k) result[k] = values[k];
  return result;
}

SUREFOOT_ONCE double measure_size(const BoundSimulator& bound, const AttachedEffect& attached, const Measure& measure) {
  const auto at = static_cast<std::size_t>(attached.at);
  const auto inputs = bound.info.inputs.size();
  double value = 1, effort = 1, position = 1, rate = 1;
  switch (attached.effect->place) {
    case Place::velocity:
    case Place::state: {
      value = bound.sizes.state[at];
      effort = bound.sizes.effort[at];
      rate = bound.sizes.rate[at];
      const int of = bound.structure.position_of[at];
      if (of >= 0) position = bound.sizes.position[static_cast<std::size_t>(of)];
      break;
    }
    case Place::input:
      value = at < inputs ? bound.sizes.input[at] : bound.sizes.signal[at - inputs];
      break;
    case Place::output:
      value = bound.sizes.output[at];
      break;
    case Place::planar:
    case Place::parameter:
      break;
  }
  return std::pow(effort, measure.effort) * std::pow(value, measure.value) * std::pow(position, measure.position) *
         std::pow(rate, measure.rate) * std::pow(bound.sizes.time, measure.time);
}

SUREFOOT_ONCE void append_unit(std::string& above, std::string& below, const std::string& unit, int power) {
  if (unit.empty() || unit == "1") return;
  for (int i = 0; i < std::abs(power); ++i) {
    std::string& side = power > 0 ? above : below;
    const bool compound = unit.find('/') != std::string::npos && power < 0;
    side += (side.empty() ? "" : " ") + (compound ? "(" + unit + ")" : unit);
  }
}

SUREFOOT_ONCE std::string measure_unit(const BoundSimulator& bound, const AttachedEffect& attached,
                                       const Measure& measure) {
  const auto at = static_cast<std::size_t>(attached.at);
  const bool map = bound.info.kind == SimulatorKind::map;
  std::string value, effort, position;
  switch (attached.effect->place) {
    case Place::velocity:
    case Place::state: {
      const StateInfo& state = bound.info.states[at];
      value = state.unit;
      const bool force = attached.effect->place == Place::velocity && !state.effort_unit.empty();
      effort = force ? state.effort_unit : map ? state.unit : state.unit + "/s";
      const int of = bound.structure.position_of[at];
      if (of >= 0) position = bound.info.states[static_cast<std::size_t>(of)].unit;
      break;
    }
    case Place::input:
      if (at < bound.info.inputs.size()) value = bound.info.inputs[at].unit;
      break;
    case Place::output:
      value = bound.info.outputs[at].unit;
      break;
    case Place::planar:
      value = "m";
      position = "rad";
      break;
    case Place::parameter:
      break;
  }
  std::string above, below;
  append_unit(above, below, effort, measure.effort);
  append_unit(above, below, value, measure.value + measure.rate);
  append_unit(above, below, position, measure.position);
  append_unit(above, below, map ? "step" : "s", measure.time - measure.rate);
  if (above.empty()) above = "1";
  if (below.empty()) return above;
  return above + "/" + (below.find(' ') != std::string::npos ? "(" + below + ")" : below);
}

SUREFOOT_INLINE double& value_of(Hypothesis& hypothesis, const Variable& variable) {
  switch (variable.kind) {
    case Variable::Kind::parameter:
      return hypothesis.parameters[static_cast<Eigen::Index>(variable.index)];
    case Variable::Kind::effect:
      return hypothesis.values[variable.index][static_cast<Eigen::Index>(variable.item)];
    case Variable::Kind::start: {
      const std::size_t parameters = hypothesis.effects[variable.index].effect->parameters.size();
      return hypothesis.values[variable.index][static_cast<Eigen::Index>(parameters + variable.item)];
    }
    case Variable::Kind::initial:
      break;
  }
  return hypothesis.initial[variable.item][static_cast<Eigen::Index>(variable.index)];
}

SUREFOOT_ONCE std::vector<Variable> variables_of(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                 const std::vector<std::size_t>& recordings, Free free) {
  constexpr double logarithmic_range =
      10;                               // high / low, from which on a positive variable is searched by its logarithm
  constexpr double least_scale = 0.02;  // of the range, for a variable that is near zero
  constexpr double initial_range = 20;  // times its scale, on both sides
  std::vector<Variable> variables;
  if (free != Free::initial_only) {
    for (std::size_t i = 0; i < bound.info.parameters.size(); ++i) {
      const ParameterInfo& info = bound.info.parameters[i];
      if (info.fixed || !(info.high > info.low)) continue;
      const bool logarithmic = info.low > 0 && info.high / info.low >= logarithmic_range;
      const double now = std::abs(hypothesis.parameters[static_cast<Eigen::Index>(i)]);
      variables.push_back({Variable::Kind::parameter, i, 0, info.low, info.high,
                           std::max(now, least_scale * (info.high - info.low)), logarithmic});
    }
  }
  if (free == Free::everything) {
    for (std::size_t e = 0; e < hypothesis.effects.size(); ++e) {
      const auto& parameters = hypothesis.effects[e].effect->parameters;
      for (std::size_t k = 0; k < parameters.size(); ++k) {
        const double unit = measure_size(bound, hypothesis.effects[e], parameters[k].measure);
        const double value = hypothesis.values[e][static_cast<Eigen::Index>(k)], now = std::abs(value);
        // a value that was given is within its bounds, whatever these recordings show
        double low = std::min(parameters[k].low * unit, value), high = std::max(parameters[k].high * unit, value);
        const auto& given = hypothesis.effects[e].bounds;
        if (!given.empty() && !std::isnan(given[k].low)) {
          low = given[k].low;
          high = given[k].high;
        }
        if (!(high > low)) continue;
        const bool logarithmic = low > 0 && high / low >= logarithmic_range;
        variables.push_back(
            {Variable::Kind::effect, e, k, low, high, std::max(now, least_scale * (high - low)), logarithmic});
      }
    }
  }
  for (const std::size_t r : recordings) {
    const Recording& recording = bound.recordings[r];
    for (Eigen::Index i = 0; i < recording.initial_scale.size(); ++i) {
      const double scale = recording.initial_scale[i];
      if (!(scale > 0)) continue;
      const double middle = recording.initial[i];
      variables.push_back({Variable::Kind::initial, static_cast<std::size_t>(i), r, middle - initial_range * scale,
                           middle + initial_range * scale, scale, false});
    }
    for (std::size_t e = 0; e < hypothesis.effects.size(); ++e) {
      const AttachedEffect& attached = hypothesis.effects[e];
      if (!attached.effect->starts_anywhere) continue;
      const double scale = measure_size(bound, attached, *attached.effect->start_measure);
      double low = -initial_range * scale, high = initial_range * scale;
      const auto at = static_cast<std::size_t>(attached.at);
      if (attached.effect->place == Place::input && at < bound.sizes.input_low.size()) {
        const double first = recording.inputs(attached.at, 0);  // what follows an input stays within its range
        low = bound.sizes.input_low[at] - first;
        high = bound.sizes.input_high[at] - first;
        if (!(high > low)) continue;
      }
      variables.push_back({Variable::Kind::start, e, r, low, high, scale, false});
    }
  }
  return variables;
}

}  // namespace surefoot::diagnosis
