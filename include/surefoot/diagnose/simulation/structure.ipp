// Definitions of surefoot/diagnose/simulation/structure.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/simulation/structure.hpp"
#include "surefoot/diagnose/simulator.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Sizes unit_sizes(const SimulatorInfo& info) {
  Sizes sizes;
  sizes.state.assign(info.states.size(), 1.0);
  sizes.rate = sizes.effort = sizes.position = sizes.state;
  sizes.input.assign(info.inputs.size(), 1.0);
  sizes.signal.assign(info.signals.size(), 1.0);
  sizes.output.assign(info.outputs.size(), 1.0);
  sizes.state_peak = sizes.state;
  sizes.input_high = sizes.input;
  sizes.input_low.assign(info.inputs.size(), -1.0);
  sizes.signal_peak = sizes.signal;
  sizes.least.assign(info.inputs.size() + info.signals.size(), 0.0);
  return sizes;
}

SUREFOOT_ONCE Eigen::VectorXd other_parameters(const SimulatorInfo& info, Eigen::VectorXd parameters) {
  constexpr double share = 0.1;  // of the way to the upper bound, or back from it
  for (Eigen::Index k = 0; k < parameters.size(); ++k) {
    const ParameterInfo& one = info.parameters[static_cast<std::size_t>(k)];
    if (one.fixed || !(one.high > one.low)) continue;
    parameters[k] += share * ((parameters[k] < one.high ? one.high : one.low) - parameters[k]);
  }
  return parameters;
}

SUREFOOT_ONCE const Recording& with_other_constants(const std::vector<Recording>& recordings) {
  for (const Recording& one : recordings) {
    if (one.constants != recordings.front().constants) return one;
  }
  return recordings.front();
}

SUREFOOT_ONCE void check_size(int fixed_size, std::size_t named, const SimulatorInfo& info, const char* type) {
  if (fixed_size == Eigen::Dynamic || fixed_size == static_cast<int>(named)) return;
  throw DiagnoseError("simulator '" + info.name + "': " + type + " has " + std::to_string(fixed_size) +
                      " components, but info() names " + std::to_string(named));
}

/// Whether two numbers are the same but for rounding.
SUREFOOT_ONCE bool nearly_equal(double a, double b) {
  return std::abs(a - b) <= 1e-9 * (1 + std::abs(a) + std::abs(b));
}

/// What no point has refuted yet.
struct StructureSearch {
  std::vector<std::vector<bool>> speed;       // [i][j]: the rate of state i is state j
  std::vector<std::vector<bool>> reads;       // [i][k]: output k reads state i
  Eigen::MatrixXd offset, slope;              // (i, k): in this way
  std::vector<std::vector<bool>> depends_on;  // [i][j]: the rate, or next value, of state i depends on state j
  std::vector<bool> driven;                   // [i]: the rate of state i changes with the inputs
};

SUREFOOT_ONCE void refute(StructureSearch& search, const Eigen::VectorXd& x, const Eigen::VectorXd& rate,
                          const Eigen::VectorXd& y) {
  for (std::size_t i = 0; i < search.speed.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < search.speed.size(); ++j) {
      if (i == j || !nearly_equal(rate[row], x[static_cast<Eigen::Index>(j)])) search.speed[i][j] = false;
    }
    for (std::size_t k = 0; k < search.reads[i].size(); ++k) {
      const auto output = static_cast<Eigen::Index>(k);
      const double reading = search.offset(row, output) + search.slope(row, output) * x[row];
      if (!nearly_equal(y[output], reading)) search.reads[i][k] = false;
    }
  }
}

/// Supposes that each output reads each state by the straight line through two points.
SUREFOOT_ONCE void suppose_readings(StructureSearch& search, const SimulatorAnswers& answers, const Eigen::VectorXd& x,
                                    const Eigen::VectorXd& u) {
  const Eigen::VectorXd here = answers.outputs(x, u, false);
  search.offset.resize(x.size(), here.size());
  search.slope.resize(x.size(), here.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Eigen::VectorXd moved = x;
    moved[i] += 1;
    const Eigen::VectorXd there = answers.outputs(moved, u, false);
    for (Eigen::Index k = 0; k < here.size(); ++k) {
      const double slope = (there[k] - here[k]) / (moved[i] - x[i]);
      if (nearly_equal(slope, 0)) search.reads[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] = false;
      const bool as_it_is = nearly_equal(slope, 1) && nearly_equal(here[k], x[i]);
      search.slope(i, k) = as_it_is ? 1 : slope;
      search.offset(i, k) = as_it_is ? 0 : here[k] - slope * x[i];
    }
  }
}

/// Whether a state in this unit is a speed, although the model may have no state that it is the rate of.
SUREFOOT_ONCE bool is_speed_unit(const std::string& unit) {
  constexpr std::array<const char*, 9> speeds{"m/s",   "cm/s", "mm/s",    "km/h", "rad/s",
                                               "deg/s", "rpm",  "rev/min", "rev/s"};
  return std::find(speeds.begin(), speeds.end(), unit) != speeds.end();
}

/// Compares the rates at a point with those after each state was moved from it.
SUREFOOT_ONCE void find_dependencies(StructureSearch& search, const SimulatorAnswers& answers,
                                     const Eigen::VectorXd& x, const Eigen::VectorXd& u, const Eigen::VectorXd& rate,
                                     double scale, Rng& rng) {
  for (std::size_t j = 0; j < search.speed.size(); ++j) {
    Eigen::VectorXd moved = x;
    moved[static_cast<Eigen::Index>(j)] += scale * (0.1 + rng.uniform());
    const Eigen::VectorXd changed = answers.rates(moved, u, nullptr);
    for (std::size_t i = 0; i < search.speed.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (!nearly_equal(rate[row], changed[row])) search.depends_on[i][j] = true;
    }
  }
}

/// States whose next values depend on inputs alone, or on others of that kind.
SUREFOOT_ONCE std::vector<bool> states_that_remember(const StructureSearch& search) {
  const std::size_t n = search.depends_on.size();
  std::vector<bool> remembers(n, false);
  for (std::size_t round = 0; round < n; ++round) {  // each finds what keeps what the one before keeps
    for (std::size_t i = 0; i < n; ++i) {
      bool only = true;
      for (std::size_t j = 0; j < n; ++j) only = only && (!search.depends_on[i][j] || (j != i && remembers[j]));
      remembers[i] = only;
    }
  }
  return remembers;
}

/// States between the inputs and what moves, as the current of a coil, the pressure behind a valve or the sum of a
/// controller: the inputs lead to them, by themselves or through others of that kind.
SUREFOOT_ONCE std::vector<bool> actuator_states(const StructureSearch& search, const SimulatorStructure& structure) {
  const std::size_t n = search.driven.size();
  std::vector<bool> may_be(n, true), result(n, false);
  for (std::size_t i = 0; i < n; ++i) {
    if (structure.velocity[i]) may_be[i] = false;
    if (structure.position_of[i] >= 0) may_be[static_cast<std::size_t>(structure.position_of[i])] = false;
  }
  for (std::size_t round = 0; round < n; ++round) {  // each finds what those of the one before lead to
    for (std::size_t i = 0; i < n; ++i) {
      bool led_to = search.driven[i];
      for (std::size_t j = 0; j < n; ++j) led_to = led_to || (result[j] && search.depends_on[i][j]);
      result[i] = may_be[i] && led_to;
    }
  }
  return result;
}

/// Fills in what remains true.
SUREFOOT_ONCE void conclude_structure(const StructureSearch& search, const SimulatorInfo& info,
                                      SimulatorStructure& structure) {
  const std::size_t n = info.states.size();
  structure.position_of.assign(n, -1);
  structure.velocity.assign(n, false);
  structure.output_of.assign(n, -1);
  structure.reading_offset.assign(n, 0);
  structure.reading_slope.assign(n, 1);
  const bool map = info.kind == SimulatorKind::map;
  structure.remembers = map ? states_that_remember(search) : std::vector<bool>(n, false);
  structure.affects_rates.assign(n, map);
  structure.all_states_measured = true;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n && info.kind == SimulatorKind::ode; ++j) {
      if (search.speed[i][j]) structure.position_of[j] = static_cast<int>(i);
    }
    for (std::size_t k = 0; k < search.reads[i].size(); ++k) {
      if (!search.reads[i][k]) continue;
      const auto row = static_cast<Eigen::Index>(i), output = static_cast<Eigen::Index>(k);
      const double offset = search.offset(row, output), slope = search.slope(row, output);
      const bool as_it_is = offset == 0 && slope == 1;
      if (!as_it_is && (structure.output_of[i] >= 0 || info.planar)) continue;  // a pose is read in m and rad
      structure.output_of[i] = static_cast<int>(k);
      structure.reading_offset[i] = offset;
      structure.reading_slope[i] = slope;
    }
    for (std::size_t j = 0; j < n; ++j) {
      if (search.depends_on[j][i]) structure.affects_rates[i] = true;
    }
    if (structure.output_of[i] >= 0) structure.remembers[i] = false;  // what is measured is more than kept
    structure.all_states_measured =
        structure.all_states_measured && (structure.output_of[i] >= 0 || structure.remembers[i]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const StateInfo& state = info.states[i];
    structure.velocity[i] = info.kind == SimulatorKind::ode && (structure.position_of[i] >= 0 ||
                                                                !state.effort_unit.empty() || is_speed_unit(state.unit));
  }
  structure.actuator = actuator_states(search, structure);
}

/// States on which a force does anything by way of the simulator's response. Throws a DiagnoseError where the response
/// is none of forces: not in proportion to them, or against them.
SUREFOOT_ONCE std::vector<int> pushed_states(const SimulatorAnswers& answers, const SimulatorInfo& info,
                                             const Eigen::VectorXd& x, const Eigen::VectorXd& u) {
  std::vector<int> pushed;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(x.size());
    force[i] = 1;
    const Eigen::VectorXd once = answers.response(x, u, force);
    force[i] = 2;
    const Eigen::VectorXd twice = answers.response(x, u, force);
    bool any = false, linear = true;
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      any = any || once[k] != 0;
      linear = linear && std::abs(twice[k] - 2 * once[k]) <= 1e-6 * std::abs(once[i]);
    }
    if (!any) continue;
    const std::string& name = info.states[static_cast<std::size_t>(i)].name;
    if (!linear) {
      throw DiagnoseError("simulator '" + info.name + "': twice the force on " + name +
                          " does not change the rates twice as much; rates must be linear in it");
    }
    if (!(once[i] > 0)) {
      throw DiagnoseError("simulator '" + info.name + "': a force on " + name + " does not make " + name +
                          " grow; add it to the rate of " + name + " with a positive sign");
    }
    pushed.push_back(static_cast<int>(i));
  }
  return pushed;
}

/// Velocities that some input moves together with another one.
SUREFOOT_ONCE std::vector<int> moved_together(const SimulatorAnswers& answers, const std::vector<bool>& velocity,
                                              const Eigen::VectorXd& x, const Eigen::VectorXd& u) {
  std::vector<bool> together(velocity.size(), false);
  const Eigen::VectorXd rate = answers.rates(x, u, nullptr);
  for (Eigen::Index k = 0; k < u.size(); ++k) {
    Eigen::VectorXd moved = u;
    moved[k] += 1e-3;  // within the limits of what it drives
    const Eigen::VectorXd changed = answers.rates(x, moved, nullptr);
    std::vector<std::size_t> driven;
    for (std::size_t i = 0; i < velocity.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (velocity[i] && !nearly_equal(rate[row], changed[row])) driven.push_back(i);
    }
    for (const std::size_t i : driven) together[i] = together[i] || driven.size() > 1;
  }
  std::vector<int> result;
  for (std::size_t i = 0; i < together.size(); ++i) {
    if (together[i]) result.push_back(static_cast<int>(i));
  }
  return result;
}

/// The speeds that a signal is a force on: their rates grow in proportion to it, as they would not with a mass.
SUREFOOT_ONCE std::vector<bool> pushed_by(const SimulatorAnswers& answers, const SimulatorStructure& structure,
                                          const Eigen::VectorXd& x, const Eigen::VectorXd& u, std::size_t signal) {
  constexpr double proportional = 1e-6;  // of the change: rounding bends no more
  const Eigen::VectorXd none = answers.rates(x, u, nullptr), once = answers.rates_beside(x, u, signal, 1),
                        twice = answers.rates_beside(x, u, signal, 2);
  std::vector<bool> result(structure.velocity.size(), false);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double change = once[row] - none[row], bend = twice[row] - once[row] - change;
    const double rounding = 1e-12 * (std::abs(none[row]) + std::abs(twice[row]));
    result[i] = structure.velocity[i] && !nearly_equal(none[row], once[row]) &&
                std::abs(bend) <= proportional * std::abs(change) + rounding;
  }
  return result;
}

/// Signals that the inputs reach through states of an actuator alone and that move something, as the torque of a
/// current does.
SUREFOOT_ONCE std::vector<bool> forces_of_actuators(const SimulatorAnswers& answers,
                                                    const SimulatorStructure& structure, const Eigen::VectorXd& x,
                                                    const Eigen::VectorXd& u) {
  std::vector<double> before(structure.driven_signal.size()), after = before;
  answers.rates(x, u, &before);
  Eigen::VectorXd moved = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (structure.actuator[static_cast<std::size_t>(i)]) moved[i] += 0.1 * (1 + std::abs(x[i]));
  }
  answers.rates(moved, u, &after);
  std::vector<bool> result(structure.driven_signal.size(), false);
  for (std::size_t k = 0; k < result.size(); ++k) {
    if (structure.driven_signal[k] || nearly_equal(before[k], after[k])) continue;
    const std::vector<bool> pushed = pushed_by(answers, structure, x, u, k);
    result[k] = std::find(pushed.begin(), pushed.end(), true) != pushed.end();
  }
  return result;
}

/// Signals that do not depend on the inputs and are a force on several speeds.
SUREFOOT_ONCE std::vector<bool> couplings(const SimulatorAnswers& answers, const SimulatorStructure& structure,
                                          const Eigen::VectorXd& x, const Eigen::VectorXd& u) {
  std::vector<bool> result(structure.driven_signal.size(), false);
  for (std::size_t k = 0; k < result.size(); ++k) {
    if (structure.driven_signal[k]) continue;
    const std::vector<bool> pushed = pushed_by(answers, structure, x, u, k);
    result[k] = std::count(pushed.begin(), pushed.end(), true) > 1;
  }
  return result;
}

/// Notes inputs with which some output changes while the states stay.
SUREFOOT_ONCE void note_inputs_shown_at_once(const SimulatorAnswers& answers, const Eigen::VectorXd& x,
                                             const Eigen::VectorXd& u, SimulatorStructure& structure) {
  const Eigen::VectorXd before = answers.outputs(x, u, false);
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    Eigen::VectorXd moved = u;
    moved[i] += 0.1 * (1 + std::abs(u[i]));
    const Eigen::VectorXd after = answers.outputs(x, moved, false);
    for (Eigen::Index k = 0; k < after.size(); ++k) {
      if (!nearly_equal(before[k], after[k])) structure.shown_at_once[static_cast<std::size_t>(i)] = true;
    }
  }
}

SUREFOOT_ONCE SimulatorStructure find_structure(const SimulatorAnswers& answers, const SimulatorInfo& info,
                                                const Recording& example) {
  const auto n = info.states.size(), m = info.inputs.size(), k = info.outputs.size();
  SimulatorStructure structure;
  structure.driven_signal.assign(info.signals.size(), false);
  structure.shown_at_once.assign(m, false);
  StructureSearch search{std::vector(n, std::vector<bool>(n, true)),
                         std::vector(n, std::vector<bool>(k, true)),
                         {},
                         {},
                         std::vector(n, std::vector<bool>(n, false)),
                         std::vector<bool>(n, false)};
  Rng rng(1);
  std::vector<double> signals(info.signals.size());
  constexpr int rounds = 36;
  constexpr std::array<double, 3> scales{1e-3, 0.1, 1};  // so that signals are met within their limits, too
  for (int round = 0; round < rounds; ++round) {
    const double scale = scales[static_cast<std::size_t>(round) % scales.size()];
    Eigen::VectorXd x(static_cast<Eigen::Index>(n)), u = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(m));
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = example.initial[i] + scale * (0.2 + rng.uniform());
    if (example.rows() > 0 && m > 0) {
      const auto row = static_cast<Eigen::Index>(rng.uniform() * static_cast<double>(example.rows()));
      for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = example.inputs(i, row);
    }
    const Eigen::VectorXd rate = answers.rates(x, u, &signals);
    const std::vector<double> first = signals;
    if (round == 0 && answers.response) structure.pushed = pushed_states(answers, info, x, u);
    if (round == 0) suppose_readings(search, answers, x, u);
    for (const bool otherwise : {false, true}) refute(search, x, rate, answers.outputs(x, u, otherwise));
    find_dependencies(search, answers, x, u, rate, scale, rng);
    const double reach = (round % 2 == 0 ? 10 : -10) * scale;
    for (double& value : u) value += reach * (0.1 + rng.uniform());
    const Eigen::VectorXd driven = answers.rates(x, u, &signals);
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (!nearly_equal(rate[row], driven[row])) search.driven[i] = true;
    }
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (!nearly_equal(first[i], signals[i])) structure.driven_signal[i] = true;
    }
    note_inputs_shown_at_once(answers, x, u, structure);
  }
  conclude_structure(search, info, structure);
  const Eigen::VectorXd first = example.inputs.cols() > 0 && m > 0
                                    ? surefoot::detail::column_of(example.inputs, 0)
                                    : Eigen::VectorXd::Zero(static_cast<Eigen::Index>(m));
  Eigen::VectorXd beside = example.initial;  // where nothing is 0 by chance
  for (double& value : beside) value += 0.1 + rng.uniform();
  const std::vector<bool> reached = forces_of_actuators(answers, structure, beside, first);
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (reached[i]) structure.driven_signal[i] = true;
  }
  structure.coupling = couplings(answers, structure, beside, first);
  if (structure.pushed.empty()) {
    structure.moved_together = moved_together(answers, structure.velocity, example.initial, first);
  }
  return structure;
}

}  // namespace surefoot::diagnosis
