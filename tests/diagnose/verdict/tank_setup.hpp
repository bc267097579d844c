// Tanks ready for the stages after the calibration: four recordings to learn from and two held out.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "surefoot/diagnose/verdict/fitted_model.hpp"
#include "surefoot/diagnose/verdict/run_context.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace toys {

/// A constant inflow [m/s] that the model leaves out.
inline std::vector<surefoot::NamedEffect> extra_inflow() { return {{"constant_rate", "level", {}, {}, {0.2}}}; }

/// Recordings of 120 rows of a tank with these effects, and noise [m].
inline std::vector<surefoot::Recording> noisy_tanks(const std::vector<surefoot::NamedEffect>& effects, double noise,
                                                    int count = 6) {
  std::vector<surefoot::Recording> recordings;
  surefoot::Rng rng(2);
  for (int r = 0; r < count; ++r) {
    surefoot::Recording recording = tank_recording(r, 120);
    recording.outputs = simulate_augmented(LeakyTank{}, machine({1, 1}, effects), recording).outputs;
    for (double& level : recording.outputs.reshaped()) level += noise * rng.normal();
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

inline const surefoot::diagnosis::BindSimulator bind_tank = [](std::vector<surefoot::Recording> recordings) {
  return surefoot::diagnosis::bind_simulator(LeakyTank{}, std::move(recordings));
};

inline surefoot::diagnosis::EstimationSetup tank_setup(std::vector<surefoot::Recording> recordings,
                                                       double sigma = 0.01) {
  using namespace surefoot::diagnosis;
  EstimationSetup setup{bind_simulator(LeakyTank{}, std::move(recordings)), {{0, 1, 2, 3}, {4, 5}, {{0, 1}, {2, 3}}}};
  setup.problem.recordings = setup.split.training;
  setup.problem.weighting.sigma.setConstant(1, sigma);
  setup.problem.integration = setup.bound.integration;
  const Hypothesis nominal = nominal_hypothesis(setup.bound);
  const auto runs = simulate_all(setup.bound, nominal, setup.split.training, setup.bound.integration, serially());
  setup.bound.sizes = measure_sizes(setup.bound, nominal, setup.split.training, runs);
  return setup;
}

/// The nominal tank with these effects attached.
inline surefoot::diagnosis::Hypothesis with_effects(const surefoot::diagnosis::EstimationSetup& setup,
                                                    const std::vector<surefoot::NamedEffect>& effects) {
  surefoot::diagnosis::Hypothesis hypothesis = nominal_hypothesis(setup.bound);
  for (const surefoot::NamedEffect& named : effects) {
    hypothesis.effects.push_back(attach(setup.bound.info, named, surefoot::all_effects()));
    hypothesis.values.emplace_back(
        Eigen::Map<const Eigen::VectorXd>(named.values.data(), static_cast<Eigen::Index>(named.values.size())));
  }
  return hypothesis;
}

}  // namespace toys
