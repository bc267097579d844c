// A hypothesis: which effects act, with which parameters, from which initial states; and its variables for a fit.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/diagnose/simulation/bound_simulator.hpp"

namespace surefoot::diagnosis {

/// Values are in units of the model. Those of an effect are its parameters and, if it begins anywhere, by how much its
/// first hidden state is off at the beginning of each recording of the bound.
struct Hypothesis {
  std::vector<AttachedEffect> effects;
  Eigen::VectorXd parameters;
  std::vector<Eigen::VectorXd> values;   // by effect
  std::vector<Eigen::VectorXd> initial;  // by recording of the bound
};

/// The simulator as it is.
Hypothesis nominal_hypothesis(const BoundSimulator& bound);

SimulatedRun simulate(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t recording,
                      const Integration& integration);

/// Trajectories of some recordings.
std::vector<SimulatedRun> simulate_all(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                       const std::vector<std::size_t>& recordings, const Integration& integration,
                                       const Parallel& parallel);

/// All but one of the effects.
Hypothesis without_effect(const Hypothesis& whole, std::size_t effect);

/// As if no sensor rounded: what is inside of a step tells no fit which way to go.
Hypothesis without_rounding(Hypothesis hypothesis);

/// The parameters among the values of an effect, with nothing known yet of how it begins in each of the recordings.
Eigen::VectorXd values_before_starts(const Effect& effect, const Eigen::VectorXd& values, std::size_t recordings);

/// Size in the recordings of a measure at the place an effect is attached to.
double measure_size(const BoundSimulator& bound, const AttachedEffect& attached, const Measure& measure);

void append_unit(std::string& above, std::string& below, const std::string& unit, int power);

/// Unit of a measure at the place an effect is attached to.
std::string measure_unit(const BoundSimulator& bound, const AttachedEffect& attached, const Measure& measure);

/// A scalar that a fit may change.
struct Variable {
  enum class Kind : unsigned char { parameter, effect, initial, start } kind = Kind::parameter;
  std::size_t index = 0;  // of the parameter, of the effect, of the state
  std::size_t item = 0;   // parameter of the effect; recording
  double low = 0, high = 0, scale = 1;
  bool logarithmic = false;
};

double& value_of(Hypothesis& hypothesis, const Variable& variable);

/// Whether one recording has the variable for itself: how it begins.
inline bool is_of_one_recording(const Variable& variable) {
  return variable.kind == Variable::Kind::initial || variable.kind == Variable::Kind::start;
}

/// Searched coordinates of a variable: its value, or the logarithm, in units of its scale.
inline double to_search(const Variable& variable, double value) {
  return variable.logarithmic ? std::log(std::max(value, variable.low)) : value / variable.scale;
}
inline double from_search(const Variable& variable, double z) {
  const double value = variable.logarithmic ? std::exp(z) : z * variable.scale;
  return std::clamp(value, variable.low, variable.high);
}

/// What a fit may change. all_but_effects: the parameters of the simulator and initial states, those of effects as
/// well.
enum class Free : unsigned char { everything, all_but_effects, initial_only };

/// What a fit of this hypothesis to these recordings may change, initial states last.
std::vector<Variable> variables_of(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                   const std::vector<std::size_t>& recordings, Free free = Free::everything);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/hypothesis.ipp"
#endif
