// Six tanks in which a search looks for effects that the test knows.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/effects/constant_rate.hpp"
#include "surefoot/diagnose/effects/sensor_bias.hpp"
#include "surefoot/diagnose/effects/sensor_drift.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"
#include "surefoot/diagnose/selection/search.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {

/// Tanks of 120 rows that these effects act on, with noise of 1 cm and the right parameters, and three candidates: a
/// constant rate, a drift and a bias of the sensor.
struct TankBench {
  BoundSimulator bound;
  SearchProblem problem;
  std::vector<AttachedEffect> candidates;
  Parallel parallel = serially();

  explicit TankBench(const std::vector<NamedEffect>& truth) {
    std::vector<Recording> recordings;
    Rng rng(1);
    for (int r = 0; r < 6; ++r) {
      Recording recording = toys::tank_recording(r, 120);
      recording.outputs = simulate_augmented(toys::LeakyTank{}, toys::machine({1, 1}, truth), recording).outputs;
      for (double& level : recording.outputs.reshaped()) level += 0.01 * rng.normal();
      recordings.push_back(std::move(recording));
    }
    bound = bind_simulator(toys::LeakyTank{}, std::move(recordings));
    problem.fit.recordings = problem.screened = {0, 1, 2, 3, 4, 5};
    problem.fit.weighting.sigma.setConstant(1, 0.01);
    problem.scale.sigma = error_scale(bound);
    problem.nominal = nominal_hypothesis(bound);
    const auto runs = simulate_all(bound, problem.nominal, problem.fit.recordings, {}, parallel);
    bound.sizes = measure_sizes(bound, problem.nominal, problem.fit.recordings, runs);
    candidates = attachments(bound, {effects::constant_rate(), effects::sensor_drift(), effects::sensor_bias()},
                             std::vector<bool>(2, true));
    problem.candidates = candidates.size();
  }
  TankBench(const TankBench&) = delete;
  TankBench& operator=(const TankBench&) = delete;

  /// Takes new readings of the tanks with these effects, whose valve goes straight from row to row; `noise` [m].
  void read_with_straight_inputs(const std::vector<NamedEffect>& truth, double noise = 0.01) {
    Rng rng(2);
    Integration straight;
    straight.inputs = {InputHold::linear};
    for (Recording& recording : bound.recordings) {
      recording.outputs =
          simulate_augmented(toys::LeakyTank{}, toys::machine({1, 1}, truth, straight), recording).outputs;
      for (double& level : recording.outputs.reshaped()) level += noise * rng.normal();
    }
  }

  /// A search under way; it keeps references to this bench.
  Search search() const { return {bound, problem, candidates, parallel}; }

  /// The tank with these effects, before any fit.
  Hypothesis start(const std::vector<std::string>& names) const {
    Hypothesis hypothesis = problem.nominal;
    for (const std::string& name : names) {
      const auto of_name = [&](const AttachedEffect& one) { return one.effect->name == name; };
      hypothesis.effects.push_back(*std::find_if(candidates.begin(), candidates.end(), of_name));
      hypothesis.values.emplace_back(Eigen::VectorXd::Constant(1, 0.01));
    }
    return hypothesis;
  }

  /// A fit with these effects, as it is evaluated.
  EvaluatedHypothesis with(const std::vector<std::string>& names) const {
    return evaluate_fit(bound, fit(bound, start(names), problem.fit, parallel), problem, parallel);
  }

  /// The whole search.
  Selection found() const {
    const Fit calibrated = fit(bound, problem.nominal, problem.fit, parallel);
    return select_effects(bound, calibrated, problem, candidates, parallel);
  }
};

/// The effects of a hypothesis in alphabetic order.
inline std::string names_in(const Hypothesis& hypothesis) {
  std::vector<std::string> names;
  for (const AttachedEffect& one : hypothesis.effects) names.push_back(one.effect->name);
  std::sort(names.begin(), names.end());
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}
inline std::string names_in(const EvaluatedHypothesis& evaluated) { return names_in(evaluated.hypothesis); }

inline const NamedEffect rate_in_tank{"constant_rate", "level", {}, {}, {0.2}},
    drift_in_tank{"sensor_drift", "level_m", {}, {}, {0.05}};

}  // namespace surefoot::diagnosis
