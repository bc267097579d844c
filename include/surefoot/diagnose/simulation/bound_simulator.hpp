// Bound simulator: a simulator together with its recordings, behind one function: what the stages of a diagnosis work
// on, so that they are compiled once and not for each simulator.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "surefoot/core/function_ref.hpp"
#include "surefoot/diagnose/simulation/simulation_run.hpp"
#include "surefoot/diagnose/simulation/structure.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

/// Runs job(0) ... job(count - 1), on whatever executor the user gave.
using Parallel = std::function<void(std::size_t count, FunctionRef<void(std::size_t)> job)>;

struct BoundSimulator {
  SimulatorInfo info;
  SimulatorStructure structure;
  Sizes sizes;
  std::vector<Recording> recordings;
  Integration integration;
  std::vector<bool> wrapped;  // by output: an angle known up to full turns only
  /// Simulates a recording. May be called from several threads.
  std::function<SimulatedRun(const BoundSimulator& self, std::size_t recording, const Eigen::VectorXd& p,
                             const Augmentation&, const Eigen::VectorXd& initial, const Integration&)>
      simulate;
  /// Forces on the states, and signals, at the rows of a trajectory.
  std::function<void(const BoundSimulator& self, std::size_t recording, const Eigen::VectorXd& p,
                     const Eigen::MatrixXd& states, Eigen::MatrixXd& efforts, Eigen::MatrixXd& signals)>
      probe;
};

/// Simulators bound to each recording; a thread takes one and gives it back.
template <Simulator S>
class SimulatorPool {
 public:
  SimulatorPool(S simulator, std::size_t recordings) : simulator_(std::move(simulator)), idle_(recordings) {}

  S take(std::size_t i, const Recording& recording) {
    {
      const std::scoped_lock lock(mutex_);
      if (!idle_[i].empty()) {
        S result = std::move(idle_[i].back());
        idle_[i].pop_back();
        return result;
      }
    }
    return for_recording(simulator_, recording);
  }

  void give_back(std::size_t i, S simulator) {
    const std::scoped_lock lock(mutex_);
    idle_[i].push_back(std::move(simulator));
  }

 private:
  S simulator_;
  std::mutex mutex_;
  std::vector<std::vector<S>> idle_;
};

/// 0 to their number: where a stage looks at all recordings.
std::vector<std::size_t> all_recordings(const BoundSimulator& bound);

double root_mean_square(const Eigen::VectorXd& values);

double standard_deviation(const Eigen::VectorXd& values);

/// The nominal values of all parameters.
Eigen::VectorXd nominal_parameters(const SimulatorInfo& info);

/// Recordings and what was found out about a simulator, still without its functions.
BoundSimulator without_functions(SimulatorInfo info, SimulatorStructure structure, std::vector<Recording> recordings);

/// Throws DiagnoseError if there is no recording.
template <Simulator S>
BoundSimulator bind_simulator(const S& simulator, std::vector<Recording> recordings) {
  if (recordings.empty()) throw DiagnoseError("there is no recording to diagnose");
  SimulatorInfo info = simulator.info();
  SimulatorStructure structure =
      find_structure(simulator, info, recordings.front(), with_other_constants(recordings), nominal_parameters(info));
  BoundSimulator bound = without_functions(std::move(info), std::move(structure), std::move(recordings));
  const auto pool = std::make_shared<SimulatorPool<S>>(simulator, bound.recordings.size());
  bound.simulate = [pool](const BoundSimulator& self, std::size_t i, const Eigen::VectorXd& p,
                          const Augmentation& augmentation, const Eigen::VectorXd& initial,
                          const Integration& integration) {
    S s = pool->take(i, self.recordings[i]);
    const Augmentation own{augmentation.effects, augmentation.values, i};
    SimulatedRun result =
        SimulationRun<S>(s, self.info, self.structure, self.sizes, self.recordings[i], p, own, integration)
            .run(initial);
    pool->give_back(i, std::move(s));
    return result;
  };
  bound.probe = [pool](const BoundSimulator& self, std::size_t i, const Eigen::VectorXd& p,
                       const Eigen::MatrixXd& states, Eigen::MatrixXd& efforts, Eigen::MatrixXd& signals) {
    S s = pool->take(i, self.recordings[i]);
    SimulationRun<S> run(s, self.info, self.structure, self.sizes, self.recordings[i], p, {}, {});
    efforts.resize(states.rows(), states.cols());
    signals.resize(static_cast<Eigen::Index>(self.info.signals.size()), states.cols());
    Eigen::VectorXd effort;
    std::vector<double> signal;
    for (Eigen::Index row = 0; row < states.cols(); ++row) {
      run.probe(converted<typename S::State>(surefoot::detail::column_of(states, row)), row, effort, signal);
      write(effort, efforts, row);
      for (std::size_t k = 0; k < signal.size(); ++k) signals(static_cast<Eigen::Index>(k), row) = signal[k];
    }
    pool->give_back(i, std::move(s));
  };
  return bound;
}

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/simulation/bound_simulator.ipp"
#endif
