// A hypothesis: which effects act, with which parameters, from which initial states. What fits search and scores judge.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/diagnose/rig.hpp"

namespace surefoot {

/// Values are in units of the model.
struct Hypothesis {
  std::vector<AttachedEffect> effects;
  Eigen::VectorXd parameters;
  std::vector<Eigen::VectorXd> values;   // by effect
  std::vector<Eigen::VectorXd> initial;  // by recording of the rig
};

/// The simulator as it is.
inline Hypothesis nominal_hypothesis(const Rig& rig) {
  Hypothesis nominal;
  nominal.parameters = nominal_parameters(rig.info);
  for (const Recording& recording : rig.recordings) nominal.initial.push_back(recording.initial);
  return nominal;
}

inline SimulatedRun simulate(const Rig& rig, const Hypothesis& hypothesis, std::size_t recording,
                             const Integration& integration) {
  return rig.simulate(rig, recording, hypothesis.parameters, {hypothesis.effects, hypothesis.values},
                      hypothesis.initial[recording], integration);
}

/// Trajectories of some recordings.
inline std::vector<SimulatedRun> simulate_all(const Rig& rig, const Hypothesis& hypothesis,
                                              const std::vector<std::size_t>& recordings,
                                              const Integration& integration, const Parallel& parallel) {
  std::vector<SimulatedRun> result(recordings.size());
  parallel(recordings.size(),
           [&](std::size_t i) { result[i] = simulate(rig, hypothesis, recordings[i], integration); });
  return result;
}

/// Size in the recordings of a measure at the place an effect is attached to.
inline double measure_size(const Rig& rig, const AttachedEffect& attached, const Measure& measure) {
  const auto at = static_cast<std::size_t>(attached.at);
  const auto inputs = rig.info.inputs.size();
  double value = 1, effort = 1, position = 1, rate = 1;
  switch (attached.effect->place) {
    case Place::velocity:
    case Place::state: {
      value = rig.sizes.state[at];
      effort = rig.sizes.effort[at];
      rate = rig.sizes.rate[at];
      const int of = rig.facts.position_of[at];
      if (of >= 0) position = rig.sizes.position[static_cast<std::size_t>(of)];
      break;
    }
    case Place::input:
      value = at < inputs ? rig.sizes.input[at] : rig.sizes.signal[at - inputs];
      break;
    case Place::output:
      value = rig.sizes.output[at];
      break;
    case Place::planar:
    case Place::parameter:
      break;
  }
  return std::pow(effort, measure.effort) * std::pow(value, measure.value) * std::pow(position, measure.position) *
         std::pow(rate, measure.rate) * std::pow(rig.sizes.time, measure.time);
}

namespace detail {

inline void append_unit(std::string& above, std::string& below, const std::string& unit, int power) {
  if (unit.empty() || unit == "1") return;
  for (int i = 0; i < std::abs(power); ++i) {
    std::string& side = power > 0 ? above : below;
    const bool compound = unit.find('/') != std::string::npos && power < 0;
    side += (side.empty() ? "" : " ") + (compound ? "(" + unit + ")" : unit);
  }
}

}  // namespace detail

/// Unit of a measure at the place an effect is attached to.
inline std::string measure_unit(const Rig& rig, const AttachedEffect& attached, const Measure& measure) {
  const auto at = static_cast<std::size_t>(attached.at);
  const bool map = rig.info.kind == SimulatorKind::map;
  std::string value, effort, position;
  switch (attached.effect->place) {
    case Place::velocity:
    case Place::state: {
      const StateInfo& state = rig.info.states[at];
      value = state.unit;
      const bool force = attached.effect->place == Place::velocity && !state.effort_unit.empty();
      effort = force ? state.effort_unit : map ? state.unit : state.unit + "/s";
      const int of = rig.facts.position_of[at];
      if (of >= 0) position = rig.info.states[static_cast<std::size_t>(of)].unit;
      break;
    }
    case Place::input:
      if (at < rig.info.inputs.size()) value = rig.info.inputs[at].unit;
      break;
    case Place::output:
      value = rig.info.outputs[at].unit;
      break;
    case Place::planar:
      value = "m";
      position = "rad";
      break;
    case Place::parameter:
      break;
  }
  std::string above, below;
  detail::append_unit(above, below, effort, measure.effort);
  detail::append_unit(above, below, value, measure.value + measure.rate);
  detail::append_unit(above, below, position, measure.position);
  detail::append_unit(above, below, map ? "step" : "s", measure.time - measure.rate);
  if (above.empty()) above = "1";
  if (below.empty()) return above;
  return above + "/" + (below.find(' ') != std::string::npos ? "(" + below + ")" : below);
}

/// One number that a fit may change.
struct Variable {
  enum class Kind : unsigned char { parameter, effect, initial } kind = Kind::parameter;
  std::size_t index = 0;  // of the parameter, of the effect, of the state
  std::size_t item = 0;   // parameter of the effect; recording
  double low = 0, high = 0, scale = 1;
  bool logarithmic = false;
};

inline double& value_of(Hypothesis& hypothesis, const Variable& variable) {
  switch (variable.kind) {
    case Variable::Kind::parameter:
      return hypothesis.parameters[static_cast<Eigen::Index>(variable.index)];
    case Variable::Kind::effect:
      return hypothesis.values[variable.index][static_cast<Eigen::Index>(variable.item)];
    case Variable::Kind::initial:
      break;
  }
  return hypothesis.initial[variable.item][static_cast<Eigen::Index>(variable.index)];
}

/// Searched coordinates of a variable: its value, or the logarithm, in units of its scale.
inline double to_search(const Variable& variable, double value) {
  return variable.logarithmic ? std::log(std::max(value, variable.low)) : value / variable.scale;
}
inline double from_search(const Variable& variable, double z) {
  const double value = variable.logarithmic ? std::exp(z) : z * variable.scale;
  return std::clamp(value, variable.low, variable.high);
}

/// What a fit may change. all_but_effects: the parameters of the simulator and initial states.
enum class Free : unsigned char { everything, all_but_effects, initial_only };

/// What a fit of this hypothesis to these recordings may change, initial states last.
inline std::vector<Variable> variables_of(const Rig& rig, const Hypothesis& hypothesis,
                                          const std::vector<std::size_t>& recordings, Free free = Free::everything) {
  std::vector<Variable> variables;
  if (free != Free::initial_only) {
    for (std::size_t i = 0; i < rig.info.parameters.size(); ++i) {
      const ParameterInfo& info = rig.info.parameters[i];
      if (info.fixed || !(info.high > info.low)) continue;
      const bool logarithmic = info.low > 0 && info.high / info.low >= 10;
      const double now = std::abs(hypothesis.parameters[static_cast<Eigen::Index>(i)]);
      variables.push_back({Variable::Kind::parameter, i, 0, info.low, info.high,
                           std::max(now, 0.02 * (info.high - info.low)), logarithmic});
    }
  }
  if (free == Free::everything) {
    for (std::size_t e = 0; e < hypothesis.effects.size(); ++e) {
      const auto& parameters = hypothesis.effects[e].effect->parameters;
      for (std::size_t k = 0; k < parameters.size(); ++k) {
        const double unit = measure_size(rig, hypothesis.effects[e], parameters[k].measure);
        const double low = parameters[k].low * unit, high = parameters[k].high * unit;
        const bool logarithmic = low > 0 && high / low >= 10;
        const double now = std::abs(hypothesis.values[e][static_cast<Eigen::Index>(k)]);
        variables.push_back({Variable::Kind::effect, e, k, low, high, std::max(now, 0.02 * (high - low)), logarithmic});
      }
    }
  }
  for (const std::size_t r : recordings) {
    const Recording& recording = rig.recordings[r];
    for (Eigen::Index i = 0; i < recording.initial_scale.size(); ++i) {
      const double scale = recording.initial_scale[i];
      if (!(scale > 0)) continue;
      const double middle = recording.initial[i];
      variables.push_back({Variable::Kind::initial, static_cast<std::size_t>(i), r, middle - 20 * scale,
                           middle + 20 * scale, scale, false});
    }
  }
  return variables;
}

}  // namespace surefoot
