// A simulator together with its recordings, behind one function: what the stages of a diagnosis work on, so that they
// are compiled once and not for each simulator.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/diagnose/facts.hpp"
#include "surefoot/diagnose/simulate.hpp"

namespace surefoot {

/// Runs job(0) ... job(count - 1), on whatever executor the user gave.
using Parallel = std::function<void(std::size_t count, const std::function<void(std::size_t)>& job)>;

struct Rig {
  SimulatorInfo info;
  SimulatorFacts facts;
  Sizes sizes;
  std::vector<Recording> recordings;
  Integration integration;
  std::vector<bool> wrapped;  // by output: an angle known up to full turns only
  /// Simulates a recording. May be called from several threads.
  std::function<SimulatedRun(const Rig& self, std::size_t recording, const Eigen::VectorXd& p, const Augmentation&,
                             const Eigen::VectorXd& initial, const Integration&)>
      simulate;
  /// Forces on the states, and signals, at the rows of a trajectory.
  std::function<void(const Rig& self, std::size_t recording, const Eigen::VectorXd& p, const Eigen::MatrixXd& states,
                     Eigen::MatrixXd& efforts, Eigen::MatrixXd& signals)>
      probe;
};

namespace detail {

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

inline double root_mean_square(const Eigen::Ref<const Eigen::RowVectorXd>& values) {
  double sum = 0;
  Eigen::Index count = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value * value;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

inline double spread(const Eigen::Ref<const Eigen::RowVectorXd>& values) {
  double sum = 0, squares = 0;
  Eigen::Index count = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value;
    squares += value * value;
    ++count;
  }
  if (count < 2) return 0;
  const double mean = sum / static_cast<double>(count);
  return std::sqrt(std::max(0.0, squares / static_cast<double>(count) - mean * mean));
}

}  // namespace detail

/// The nominal values of all parameters.
inline Eigen::VectorXd nominal_parameters(const SimulatorInfo& info) {
  Eigen::VectorXd p(static_cast<Eigen::Index>(info.parameters.size()));
  for (std::size_t i = 0; i < info.parameters.size(); ++i) p[static_cast<Eigen::Index>(i)] = info.parameters[i].value;
  return p;
}

template <Simulator S>
Rig make_rig(const S& simulator, std::vector<Recording> recordings) {
  if (recordings.empty()) throw DiagnoseError("there is no recording to diagnose");
  Rig rig;
  rig.info = simulator.info();
  rig.facts = find_facts(simulator, rig.info, recordings.front(), nominal_parameters(rig.info));
  rig.sizes = unit_sizes(rig.info);
  rig.recordings = std::move(recordings);
  for (std::size_t k = 0; k < rig.info.outputs.size(); ++k) {
    bool wrapped = rig.info.outputs[k].unit == "rad";
    for (const Recording& recording : rig.recordings) {
      for (const double value : recording.outputs.row(static_cast<Eigen::Index>(k))) {
        wrapped = wrapped && !(std::abs(value) > 3.1416);
      }
    }
    rig.wrapped.push_back(wrapped);
  }
  const auto pool = std::make_shared<detail::SimulatorPool<S>>(simulator, rig.recordings.size());
  rig.simulate = [pool](const Rig& self, std::size_t i, const Eigen::VectorXd& p, const Augmentation& augmentation,
                        const Eigen::VectorXd& initial, const Integration& integration) {
    S s = pool->take(i, self.recordings[i]);
    SimulatedRun result =
        detail::SimulationRun<S>(s, self.info, self.facts, self.sizes, self.recordings[i], p, augmentation, integration)
            .run(initial);
    pool->give_back(i, std::move(s));
    return result;
  };
  rig.probe = [pool](const Rig& self, std::size_t i, const Eigen::VectorXd& p, const Eigen::MatrixXd& states,
                     Eigen::MatrixXd& efforts, Eigen::MatrixXd& signals) {
    S s = pool->take(i, self.recordings[i]);
    detail::SimulationRun<S> run(s, self.info, self.facts, self.sizes, self.recordings[i], p, {}, {});
    efforts.resize(states.rows(), states.cols());
    signals.resize(static_cast<Eigen::Index>(self.info.signals.size()), states.cols());
    Eigen::VectorXd effort;
    std::vector<double> signal;
    for (Eigen::Index row = 0; row < states.cols(); ++row) {
      run.probe(detail::converted<typename S::State>(states.col(row)), row, effort, signal);
      efforts.col(row) = effort;
      for (std::size_t k = 0; k < signal.size(); ++k) signals(static_cast<Eigen::Index>(k), row) = signal[k];
    }
    pool->give_back(i, std::move(s));
  };
  return rig;
}

}  // namespace surefoot
