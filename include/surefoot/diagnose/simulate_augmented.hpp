// A simulator with the effects that a diagnosis found, as a value: what an augmented model file says in numbers.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/effects/named_effect.hpp"
#include "surefoot/diagnose/estimation/hypothesis.hpp"
#include "surefoot/diagnose/simulation/simulation_run.hpp"
#include "surefoot/diagnose/simulation/structure.hpp"

namespace surefoot {

struct Augmented {
  std::vector<double> parameters = {};  // of the simulator; empty: its nominal ones
  std::vector<NamedEffect> effects = {};
  Integration integration = {};
};

/// Simulates a recording from `recording.initial` on.
template <Simulator S>
SimulatedRun simulate_augmented(const S& simulator, const Augmented& augmented, const Recording& recording,
                                const std::vector<Effect>& effects = all_effects()) {
  const SimulatorInfo info = simulator.info();
  std::vector<AttachedEffect> attached;
  std::vector<Eigen::VectorXd> values;
  for (const NamedEffect& named : augmented.effects) {
    attached.push_back(attach(info, named, effects));
    values.emplace_back(static_cast<Eigen::Index>(named.values.size()));
    std::copy(named.values.begin(), named.values.end(), values.back().data());
  }
  Eigen::VectorXd p(static_cast<Eigen::Index>(info.parameters.size()));
  for (std::size_t i = 0; i < info.parameters.size(); ++i) {
    p[static_cast<Eigen::Index>(i)] =
        augmented.parameters.empty() ? info.parameters[i].value : augmented.parameters.at(i);
  }
  const diagnosis::SimulatorStructure structure = diagnosis::find_structure(simulator, info, recording, recording, p);
  S s = diagnosis::for_recording(simulator, recording);
  return diagnosis::SimulationRun<S>(s, info, structure, diagnosis::unit_sizes(info), recording, p, {attached, values},
                                     augmented.integration)
      .run(recording.initial);
}

/// Units of the values of an effect, in their order, at the nominal parameters of the simulator.
template <Simulator S>
std::vector<std::string> units_of(const S& simulator, const NamedEffect& named, const Recording& recording,
                                  const std::vector<Effect>& effects = all_effects()) {
  diagnosis::BoundSimulator bound;
  bound.info = simulator.info();
  Eigen::VectorXd p(static_cast<Eigen::Index>(bound.info.parameters.size()));
  for (Eigen::Index i = 0; i < p.size(); ++i) p[i] = bound.info.parameters[static_cast<std::size_t>(i)].value;
  bound.structure = diagnosis::find_structure(simulator, bound.info, recording, recording, p);
  const AttachedEffect attached = attach(bound.info, named, effects);
  std::vector<std::string> units;
  for (const auto& parameter : attached.effect->parameters) {
    units.push_back(diagnosis::measure_unit(bound, attached, parameter.measure));
  }
  return units;
}

}  // namespace surefoot
