// Definitions of surefoot/diagnose/selection/candidates.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/estimation/hypothesis.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

/// Inputs and signals of a recording by row, as its trajectory makes them.
SUREFOOT_ONCE Eigen::MatrixXd inputs_and_signals(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                 std::size_t recording, const SimulatedRun& trajectory) {
  Eigen::MatrixXd efforts, signals;
  bound.probe(bound, recording, hypothesis.parameters, trajectory.states, efforts, signals);
  const Eigen::MatrixXd& driven = bound.recordings[recording].inputs;
  const std::size_t count = bound.info.inputs.size() + bound.info.signals.size();
  Eigen::MatrixXd all(static_cast<Eigen::Index>(count), signals.cols());
  for (Eigen::Index column = 0; column < all.cols(); ++column) {
    for (Eigen::Index k = 0; k < all.rows(); ++k) {
      const double value = k < driven.rows() ? driven(k, column) : signals(k - driven.rows(), column);
      all(k, column) = std::isfinite(value) ? value : 0.0;
    }
  }
  return all;
}

SUREFOOT_ONCE std::vector<bool> distinct_inputs(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                const std::vector<std::size_t>& recordings,
                                                const std::vector<SimulatedRun>& trajectories, double collinear) {
  const std::size_t inputs = bound.info.inputs.size(), count = inputs + bound.info.signals.size();
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
  std::vector<bool> changes(count, false);
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (!trajectories[i].finite) continue;
    const Eigen::MatrixXd all = inputs_and_signals(bound, hypothesis, recordings[i], trajectories[i]);
    for (Eigen::Index column = 0; column < all.cols(); ++column) {
      for (Eigen::Index k = 0; k < all.rows(); ++k) {
        if (all(k, column) != all(k, 0)) changes[static_cast<std::size_t>(k)] = true;
      }
    }
    const Eigen::MatrixXd squares = surefoot::detail::product(all, surefoot::detail::transposed(all));
    for (Eigen::Index k = 0; k < squares.size(); ++k) products.data()[k] += squares.data()[k];
  }
  std::vector<bool> distinct(count, false);
  for (std::size_t k = 0; k < count; ++k) {
    const auto a = static_cast<Eigen::Index>(k);
    distinct[k] =
        changes[k] && (k < inputs || bound.structure.driven_signal[k - inputs] || bound.structure.coupling[k - inputs]);
    for (std::size_t j = 0; j < k; ++j) {
      const auto b = static_cast<Eigen::Index>(j);
      if (!distinct[j]) continue;
      const double cosine = products(a, b) / std::sqrt(std::max(products(a, a) * products(b, b), never_zero));
      if (std::abs(cosine) > collinear) distinct[k] = false;
    }
  }
  return distinct;
}

/// Calls `visit(k, value)` with each value that an input or signal k takes.
template <typename Visit>
void visit_values(const BoundSimulator& bound, const Hypothesis& hypothesis, const std::vector<std::size_t>& recordings,
                  const std::vector<SimulatedRun>& trajectories, const Visit& visit) {
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (!trajectories[i].finite) continue;
    const Eigen::MatrixXd all = inputs_and_signals(bound, hypothesis, recordings[i], trajectories[i]);
    for (Eigen::Index k = 0; k < all.rows(); ++k) {
      for (Eigen::Index column = 0; column < all.cols(); ++column) visit(static_cast<std::size_t>(k), all(k, column));
    }
  }
}

SUREFOOT_ONCE InputValues input_values(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                       const std::vector<std::size_t>& recordings,
                                       const std::vector<SimulatedRun>& trajectories) {
  constexpr double small = 0.5;  // of the largest
  const std::size_t count = bound.info.inputs.size() + bound.info.signals.size();
  std::vector<double> lowest(count, 0), highest(count, 0);
  std::vector<double> least(count, std::numeric_limits<double>::infinity());
  visit_values(bound, hypothesis, recordings, trajectories, [&](std::size_t k, double value) {
    lowest[k] = std::min(lowest[k], value);
    highest[k] = std::max(highest[k], value);
    if (value != 0) least[k] = std::min(least[k], std::abs(value));
  });
  InputValues result{std::vector<bool>(count), std::vector<bool>(count)};
  for (std::size_t k = 0; k < count; ++k) {
    result.both_signs[k] = lowest[k] < 0 && highest[k] > 0;
    result.small_values[k] = least[k] < small * std::max(-lowest[k], highest[k]);
  }
  return result;
}

SUREFOOT_ONCE std::vector<bool> zero_at_first(const BoundSimulator& bound,
                                              const std::vector<std::size_t>& recordings) {
  const std::size_t inputs = bound.info.inputs.size();
  std::vector<bool> zero(inputs + bound.info.signals.size(), true);
  for (const std::size_t r : recordings) {
    for (std::size_t k = 0; k < zero.size(); ++k) {
      const std::size_t first = k < inputs ? k : 0, last = k < inputs ? k + 1 : inputs;
      for (std::size_t i = first; i < last; ++i) {
        if (bound.recordings[r].inputs(static_cast<Eigen::Index>(i), 0) != 0) zero[k] = false;
      }
    }
  }
  return zero;
}

/// Whether a position in this unit may be an angle: unless its unit is known to be another.
SUREFOOT_ONCE bool may_be_angle(const std::string& unit) {
  constexpr std::array units{"", "1", "rad", "deg"};
  return std::find(units.begin(), units.end(), unit) != units.end();
}

/// Whether a velocity is the speed of an angle that turns round.
SUREFOOT_ONCE bool turns_round(const BoundSimulator& bound, int position) {
  if (position < 0) return false;
  const auto state = static_cast<std::size_t>(position);
  return bound.info.states[state].unit == "rad" && bound.sizes.state_peak[state] > std::numbers::pi;
}

SUREFOOT_ONCE bool fits_velocity(const BoundSimulator& bound, const Effect& effect, std::size_t state) {
  const int position = bound.structure.position_of[state];
  if (effect.needs_angle && (position < 0 || !may_be_angle(bound.info.states[static_cast<std::size_t>(position)].unit))) {
    return false;
  }
  if (effect.needs_turns && !turns_round(bound, position)) return false;
  if (!effect.needs_unit.empty() && bound.info.states[state].unit != effect.needs_unit) return false;
  bool needs_position = effect.seen_position || effect.limit;
  for (const EffectParameter& parameter : effect.parameters) {
    needs_position = needs_position || parameter.measure.position != 0;
  }
  return bound.structure.velocity[state] && (position >= 0 || !needs_position);
}

SUREFOOT_ONCE bool fits_state(const BoundSimulator& bound, const Effect& effect, std::size_t state) {
  const SimulatorInfo& info = bound.info;
  const auto i = static_cast<int>(state);
  const bool is_position = std::find(bound.structure.position_of.begin(), bound.structure.position_of.end(), i) !=
                           bound.structure.position_of.end();
  if (bound.structure.remembers[state]) return false;  // no matter is kept there, only what was commanded
  const bool pose = info.planar && (i == info.planar->x || i == info.planar->y || i == info.planar->heading);
  if (is_position || bound.structure.velocity[state] || pose) return false;  // there forces act, or walking effects
  const std::string& unit = info.states[state].unit;
  const bool angle = unit == "rad" || unit == "deg";
  return !effect.needs_conserved_state || (!angle && bound.structure.affects_rates[state]);
}

SUREFOOT_ONCE std::vector<AttachedEffect> attachments(const BoundSimulator& bound, const std::vector<Effect>& effects,
                                                      const std::vector<bool>& distinct) {
  std::vector<AttachedEffect> result;
  const SimulatorInfo& info = bound.info;
  int rank = -1;
  for (const Effect& effect : effects) {
    ++rank;
    if ((effect.needs_drive || effect.needs_load) && info.inputs.empty()) continue;  // nothing drives it
    const auto shared = std::make_shared<const Effect>(effect);
    const auto attach = [&](std::size_t at, const std::string& place, int other = -1) {
      result.push_back({shared, static_cast<int>(at), other, place, rank});
    };
    switch (effect.place) {
      case Place::velocity:
        for (std::size_t i = 0; i < info.states.size(); ++i) {
          if (fits_velocity(bound, effect, i)) attach(i, info.states[i].name);
        }
        break;
      case Place::state:
        for (std::size_t i = 0; i < info.states.size(); ++i) {
          if (!fits_state(bound, effect, i)) continue;
          if (!effect.has_overflow_target) attach(i, info.states[i].name);
          for (std::size_t j = 0; j < info.states.size() && effect.has_overflow_target; ++j) {
            if (j != i) attach(i, info.states[i].name, static_cast<int>(j));
          }
        }
        break;
      case Place::input:
        for (std::size_t i = 0; i < distinct.size(); ++i) {
          const bool coupling = i >= info.inputs.size() && bound.structure.coupling[i - info.inputs.size()];
          if (!distinct[i] || coupling != effect.needs_coupling) continue;
          attach(i, i < info.inputs.size() ? info.inputs[i].name : info.signals[i - info.inputs.size()]);
        }
        break;
      case Place::output:
        for (std::size_t i = 0; i < info.outputs.size(); ++i) attach(i, info.outputs[i].name);
        break;
      case Place::planar:
        if (info.planar) attach(0, "planar");
        break;
      case Place::parameter:
        for (std::size_t i = 0; i < info.parameters.size(); ++i) {
          if (!info.parameters[i].fixed) attach(i, info.parameters[i].name);
        }
        break;
    }
  }
  return result;
}

}  // namespace surefoot::diagnosis
