// Definitions of surefoot/diagnose/verdict/describe.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/selection/ranking.hpp"
#include "surefoot/diagnose/text.hpp"
#include "surefoot/diagnose/verdict/describe.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

/// The 95 % interval of a value, within the bounds of its variable; in proportion where that is searched by its
/// logarithm.
SUREFOOT_ONCE void set_interval(FittedValue& fitted, const Variable& variable, double deviation) {
  const double half = normal_quantile_95 * deviation, value = fitted.value;
  const bool logarithmic = variable.logarithmic && value > 0;
  fitted.low = std::max(logarithmic ? value * std::exp(-half / value) : value - half, std::min(variable.low, value));
  fitted.high = std::min(logarithmic ? value * std::exp(half / value) : value + half, std::max(variable.high, value));
}

SUREFOOT_ONCE std::vector<CalibratedParameter> calibrated_parameters(const BoundSimulator& bound,
                                                                     const Hypothesis& hypothesis,
                                                                     const StandardErrors& errors,
                                                                     const DescriptionCriteria& criteria) {
  std::vector<CalibratedParameter> result;
  for (std::size_t i = 0; i < bound.info.parameters.size(); ++i) {
    const ParameterInfo& info = bound.info.parameters[i];
    const double value = hypothesis.parameters[static_cast<Eigen::Index>(i)];
    CalibratedParameter one{{info.name, info.unit, value, value, value}, info.value, false, info.fixed};
    for (std::size_t v = 0; v < errors.variables.size(); ++v) {
      const Variable& variable = errors.variables[v];
      if (variable.kind != Variable::Kind::parameter || variable.index != i) continue;
      set_interval(one.fit, variable, errors.deviation[static_cast<Eigen::Index>(v)]);
      const double near = criteria.bound_share * (info.high - info.low);
      one.at_bound =
          value <= info.low + near * (variable.logarithmic ? value / info.high : 1) || value >= info.high - near;
    }
    result.push_back(std::move(one));
  }
  return result;
}

SUREFOOT_ONCE std::vector<std::string> correlated_pairs(const BoundSimulator& bound, const StandardErrors& errors,
                                                        const DescriptionCriteria& criteria) {
  std::vector<std::string> result;
  for (std::size_t a = 0; a < errors.variables.size(); ++a) {
    for (std::size_t b = a + 1; b < errors.variables.size(); ++b) {
      if (errors.variables[a].kind != Variable::Kind::parameter ||
          errors.variables[b].kind != Variable::Kind::parameter)
        continue;
      const double r = errors.correlation(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      if (std::abs(r) < criteria.correlation) continue;
      result.push_back(bound.info.parameters[errors.variables[a].index].name + " and " +
                       bound.info.parameters[errors.variables[b].index].name + " (correlation " + in_digits(r) + ")");
    }
  }
  return result;
}

SUREFOOT_ONCE FoundEffect describe(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t effect,
                                   const StandardErrors* errors) {
  const AttachedEffect& attached = hypothesis.effects[effect];
  FoundEffect found;
  found.name = attached.effect->name;
  found.attached_to = attached.place;
  found.form = attached.effect->form;
  if (attached.other >= 0) found.other = bound.info.states[static_cast<std::size_t>(attached.other)].name;
  const auto& parameters = attached.effect->parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double value = hypothesis.values[effect][static_cast<Eigen::Index>(k)];
    FittedValue one{parameters[k].name, measure_unit(bound, attached, parameters[k].measure), value, value, value};
    for (std::size_t v = 0; errors != nullptr && v < errors->variables.size(); ++v) {
      const Variable& variable = errors->variables[v];
      if (variable.kind != Variable::Kind::effect || variable.index != effect || variable.item != k) continue;
      set_interval(one, variable, errors->deviation[static_cast<Eigen::Index>(v)]);
      const double from = to_search(variable, variable.low), to = to_search(variable, variable.high);
      const double share = (to_search(variable, value) - from) / (to - from), near = DescriptionCriteria{}.bound_share;
      one.at_bound = (share < near && variable.low != 0) || share > 1 - near;
      one.least = variable.low;
      one.most = variable.high;
    }
    found.parameters.push_back(std::move(one));
  }
  found.sentence = fill_sentence(attached.effect->sentence, attached.place, found.parameters);
  return found;
}

SUREFOOT_ONCE std::string noise_sentence(NoiseKind noise) {
  switch (noise) {
    case NoiseKind::measurement:
      return "measurement noise: whole recordings are simulated";
    case NoiseKind::process:
      return "process noise accumulates: each row is predicted from the one before";
    case NoiseKind::final_pose:
      break;
  }
  return "process noise accumulates until the final pose: poses are weighted by its covariance";
}

SUREFOOT_ONCE std::string rejection_sentence() {
  return "effects that seemed to explain the mismatch did not lower the error on the held-out recordings, and were "
         "dropped";
}

SUREFOOT_ONCE std::string overstated_noise_sentence(const std::vector<ChannelMismatch>& outputs) {
  constexpr double more = 2;  // times what is left: estimates of a standard deviation are hardly so far off
  std::vector<std::string> names;
  for (const ChannelMismatch& one : outputs) {
    if (one.noise_stated && one.noise > more * one.rmse_after) {
      names.push_back(one.output + " (" + with_unit(one.rmse_after, one.unit) + " of " + with_unit(one.noise, one.unit) +
                      ")");
    }
  }
  if (names.empty()) return "";
  return "less is left than the stated noise of " + in_list(names) +
         ": state what the sensor really has, or nothing; what was named may be smaller than that noise";
}

SUREFOOT_ONCE std::string freed_state_sentence(const StateInfo& state, double least_off, double most_off) {
  return "recordings do not begin with " + state.name + " as the model says, but off by between " +
         with_unit(least_off, state.unit) + " and " + with_unit(most_off, state.unit) +
         ": it is free in what follows; say so in the model (a model file by initial = \"free\", C++ by "
         "Recording::initial_scale)";
}

SUREFOOT_ONCE std::string hold_sentence(const std::string& input, InputHold hold, InputHold said) {
  const auto in_model = [](InputHold one) { return "\"" + std::string(hold_name(one)) + "\""; };
  std::string way = " of each row acts since the row before, not from its own row on,";
  if (hold == InputHold::linear) way = " goes straight from row to row";
  if (hold == InputHold::band_limited) way = " goes smoothly from row to row, as a band-limited signal does,";
  const bool line = said == InputHold::linear;
  return "input " + input + way + " in what follows: recordings fit better so than with " +
         (line ? "straight lines between rows" : "values held until the next row") +
         "; say in the model which it is (a model file by hold = " + in_model(hold) + " or " + in_model(said) +
         ", C++ by InputInfo::hold)";
}

SUREFOOT_ONCE std::string moved_together_sentence(const SimulatorInfo& info, const std::vector<int>& velocities) {
  std::vector<std::string> names;
  for (const int velocity : velocities) names.push_back(info.states[static_cast<std::size_t>(velocity)].name);
  return "one input moves " + in_list(names) +
         " at once: if a force on one of them does, too, say so in the model (a model file by force = \"NAME\" and "
         "NAME in the rates, C++ by response()); friction at one then moves the others as well";
}

SUREFOOT_ONCE std::string no_speed_sentence() {
  return "no state is known to be a speed, so that neither friction nor drag nor another force was tried: where one "
         "is, say what effort moves it (a model file by effort and effort_unit, C++ by effort() of the simulator)";
}

SUREFOOT_ONCE std::string most_effects_sentence(int most) {
  return "as many effects were found as may be combined (" + std::to_string(most) +
         "), and something is left: max_effects (--max-effects) allows more";
}

SUREFOOT_ONCE std::string sensitive_recording_sentence(double seconds, std::size_t parts) {
  return "from " + in_digits(seconds) +
         " s on, differences of the start smaller than the noise decide what it does, as where a pendulum may fall "
         "over to either side: it is used as " +
         std::to_string(parts) + " parts, each from where it was measured";
}

SUREFOOT_ONCE std::string following_sentence(double rows, bool chaotic) {
  const std::string how = "simulations follow the readings, and errors are those of predictions over " +
                          in_digits(std::round(rows)) + " rows; ";
  if (chaotic) {
    return "in the motion that was recorded, differences smaller than the noise grow to what the machine does at all, "
           "so that no whole recording can be simulated: " +
           how + "shorter recordings, or ones of smaller motions, would show more";
  }
  return "the machine is unstable without its controller, which is not part of the model, so that no whole recording "
         "can be simulated: " +
         how + "a model of the controller, with its set points as inputs, would show more";
}

SUREFOOT_ONCE std::string not_held_out_sentence() {
  return "the time was over before parameters were fitted without the held-out recordings: errors on these are those "
         "of recordings that were fitted, and too small";
}

/// The last effect of a hypothesis that another one does not have; if it has all, the last.
SUREFOOT_ONCE const Effect& effect_beyond(const Hypothesis& hypothesis, const Hypothesis& other) {
  for (std::size_t e = hypothesis.effects.size(); e > 0; --e) {
    const AttachedEffect& mine = hypothesis.effects[e - 1];
    const bool shared = holds_for_any(other.effects, [&](const AttachedEffect& theirs) {
      return theirs.effect->name == mine.effect->name && theirs.place == mine.place;
    });
    if (!shared) return *mine.effect;
  }
  return *hypothesis.effects.back().effect;
}

SUREFOOT_ONCE std::string next_experiment(const Hypothesis& chosen, const Hypothesis& other) {
  const Effect &mine = effect_beyond(chosen, other), &theirs = effect_beyond(other, chosen);
  if (mine.name == theirs.name) return mine.experiment;
  std::string text = mine.experiment + ": separates " + mine.name + " from " + theirs.name;
  if (!theirs.experiment.empty() && theirs.experiment != mine.experiment) text += "; or " + theirs.experiment;
  return text;
}

/// "1.04 times the noise", or what it leaves of predictions, which may be estimated from what is left; nothing where
/// that is unknown.
SUREFOOT_ONCE std::string against_noise(const Diagnosis& diagnosis) {
  if (!std::isfinite(diagnosis.noise_ratio)) return "";
  const bool stated = holds_for_all(diagnosis.channels, [](const ChannelMismatch& one) { return one.noise_stated; });
  const bool predicted =
      holds_for_any(diagnosis.channels, [](const ChannelMismatch& one) { return one.noise_amplification > 1; });
  return in_digits(diagnosis.noise_ratio) + " times " +
         (predicted ? "what the noise leaves of predictions" : "the noise") + (stated ? "" : " as estimated");
}

/// Recordings that are further off than noise explains, in a sentence of their own.
SUREFOOT_ONCE std::string beyond_noise_sentence(const Diagnosis& diagnosis) {
  constexpr std::size_t most = 3;  // names that are told
  std::vector<std::string> names;
  for (const RecordingFit& one : diagnosis.per_recording) {
    if (one.beyond_noise) names.push_back(one.recording);
  }
  if (names.empty()) return "";
  const std::size_t count = names.size();
  if (count > most) names.resize(most);
  return " " + std::to_string(count) + " of " + std::to_string(diagnosis.per_recording.size()) +
         (count == 1 ? " recordings is" : " recordings are") + " further off than noise explains: " + in_list(names) +
         (count > most ? " and others." : ".");
}

/// By how much the error on held-out recordings falls, in how many of them, and what is left of it.
SUREFOOT_ONCE std::string gain_sentence(const Diagnosis& diagnosis) {
  const auto better =
      count_items(diagnosis.per_recording, [](const RecordingFit& one) { return one.after < one.before; });
  const std::string noise = against_noise(diagnosis);
  const double gain = 1 - diagnosis.held_out_after / std::max(diagnosis.held_out_before, never_zero);
  return std::string(" With that, the error on held-out recordings ") + (gain < 0 ? "rises" : "falls") + " by " +
         in_digits(100 * std::abs(gain)) + " %" + (noise.empty() ? "" : ", to " + noise) + "; " +
         std::to_string(better) + " of " + std::to_string(diagnosis.per_recording.size()) + " agree.";
}

/// Whether all recordings are within what an explanation may leave.
SUREFOOT_ONCE bool within_noise(const Diagnosis& diagnosis) {
  return diagnosis.noise_ratio <= VerdictCriteria{}.largest_ratio &&
         !holds_for_any(diagnosis.per_recording, [](const RecordingFit& one) { return one.beyond_noise; });
}

SUREFOOT_ONCE std::string clean_sentence(const Diagnosis& diagnosis, const std::string& parameters) {
  const std::string noise = against_noise(diagnosis);
  return "Nothing is missing: with " + parameters + " parameters the model agrees with the recordings" +
         (noise.empty() ? "." : ", to " + noise + ".");
}

SUREFOOT_ONCE std::string tie_sentence(const std::vector<std::string>& ties) {
  constexpr std::size_t most = 3;  // that are told in the sentence; the report has all
  if (ties.empty()) return "";
  std::string text = " These recordings cannot tell it from " + ties.front();
  for (std::size_t i = 1; i < std::min(most, ties.size()); ++i) text += "; or from " + ties[i];
  return text + (ties.size() > most ? "; or from others." : ".");
}

/// Of structures that were not chosen, the one whose predictions come clearly nearest; empty if there is none.
SUREFOOT_ONCE std::string nearest_sentence(const Diagnosis& diagnosis) {
  const Alternative* nearest = nullptr;
  double least = clearly_nearer * diagnosis.held_out_before;
  for (const Alternative& one : diagnosis.alternatives) {
    if (!(one.held_out_rmse < least)) continue;
    least = one.held_out_rmse;
    nearest = &one;
  }
  if (nearest == nullptr) return "";
  std::vector<std::string> names;
  for (const auto& [name, place] : nearest->effects) {
    names.push_back(name + " at " + place);
    std::replace(names.back().begin(), names.back().begin() + static_cast<std::ptrdiff_t>(name.size()), '_', ' ');
  }
  return " What comes nearest is " + in_list(names) + ": with that the error on held-out recordings would fall by " +
         in_digits(100 * (1 - least / diagnosis.held_out_before)) + " %, but too few of them show it to be sure.";
}

SUREFOOT_ONCE std::string verdict_sentence(const Diagnosis& diagnosis, const std::vector<std::string>& ties) {
  constexpr const char* more_time = " It needs more time (max_seconds, --budget).";
  std::vector<std::string> effects;
  for (const FoundEffect& effect : diagnosis.effects) effects.push_back(effect.sentence);
  switch (diagnosis.verdict) {
    case Verdict::adequate:
      return clean_sentence(diagnosis, "its nominal");
    case Verdict::parameters_only:
      return clean_sentence(diagnosis, "calibrated");
    case Verdict::missing_physics:
      return "Left out of the model: " + in_list(effects) + "." + gain_sentence(diagnosis) + tie_sentence(ties);
    case Verdict::unfinished:
      if (!effects.empty() && within_noise(diagnosis)) {
        return "The search was not finished, so that others may explain it as well as what was found: " +
               in_list(effects) + "." + gain_sentence(diagnosis) + more_time;
      }
      return "The search was not finished, so that nothing is concluded" +
             (effects.empty() ? "." : "; the best so far: " + in_list(effects) + "." + gain_sentence(diagnosis)) +
             more_time;
    case Verdict::unexplained:
      break;
  }
  std::string text = "The model leaves something out that no known effect explains";
  if (!effects.empty()) text += "; a part of it: " + in_list(effects);
  if (!diagnosis.regions.empty()) text += "; it shows where " + diagnosis.regions.front().rule;
  text += ".";
  if (!effects.empty()) return text + gain_sentence(diagnosis) + beyond_noise_sentence(diagnosis) + tie_sentence(ties);
  const std::string noise = against_noise(diagnosis);
  return text + (noise.empty() ? "" : " Its error is " + noise + ".") + beyond_noise_sentence(diagnosis) +
         nearest_sentence(diagnosis);
}

}  // namespace surefoot::diagnosis
