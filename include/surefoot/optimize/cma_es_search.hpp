// A whole search by CMA-ES as a plain struct: the descent under way, the restarts so far, and the best of all.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "surefoot/core/box.hpp"
#include "surefoot/optimize/cma_es_state.hpp"
#include "surefoot/optimize/cma_es_stop.hpp"
#include "surefoot/optimize/restarts.hpp"

namespace surefoot {

/// What a descent came to, in the user's coordinates.
struct CmaEsDescent {
  Eigen::Index population = 0;
  std::uint64_t generations = 0;
  std::uint64_t evaluations = 0;
  StopReason reason = StopReason::stop_requested;
  double best_value = std::numeric_limits<double>::infinity();
  Eigen::VectorXd best = {};  // the best candidate; of a noisy objective: the luckiest
  Eigen::VectorXd mean = {};  // where the distribution ended; of a noisy objective the better estimate
};

struct CmaEsSearch {
  // What the caller asked for.
  Eigen::VectorXd start;                   // of the first descent
  double sigma = 0;                        // of the first descent [1, or widths of the box]
  std::optional<Box<Eigen::Dynamic>> box;  // none: no bounds
  std::uint64_t seed = 0;

  // How far it is.
  CmaEsState state;
  DescentPlan plan;
  RestartSchedule schedule;
  CmaEsDescent descent;                // the one under way, its mean and reason still open
  std::vector<CmaEsDescent> finished;  // those before it
  double noise_evaluations = 1;        // of each candidate, not yet rounded
  std::uint64_t evaluations = 0;       // in total
};

struct CmaEsResult {
  Eigen::VectorXd best = {};  // empty if no generation was finished
  double best_value = std::numeric_limits<double>::infinity();
  StopReason reason = StopReason::stop_requested;
  std::uint64_t evaluations = 0;
  double seconds = 0;                       // wall clock, of this call [s]
  std::vector<CmaEsDescent> descents = {};  // in their order; only the last may have been cut short
  CmaEsSearch search = {};                  // to go on from here: cma_es(objective, result.search, ...)
};

}  // namespace surefoot
