// Options of `cma_es()`.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "surefoot/optimize/cma_es_search.hpp"
#include "surefoot/optimize/cma_es_state.hpp"
#include "surefoot/optimize/cma_es_stop.hpp"
#include "surefoot/optimize/objective.hpp"
#include "surefoot/optimize/rank_noise.hpp"
#include "surefoot/optimize/restarts.hpp"

namespace surefoot {

struct CmaEsOptions {
  double box_sigma = 0.3;       // with bounds: the first standard deviation [widths of the box]
  Eigen::Index population = 0;  // candidates of a generation; 0: 4 + 3 ln(dimension)
  Restarts restarts = Restarts::none;
  int max_restarts = 9;          // with large population
  double population_growth = 2;  // factor from one large population to the next

  double target = -std::numeric_limits<double>::infinity();                   // a value this small ends the search
  std::uint64_t max_evaluations = std::numeric_limits<std::uint64_t>::max();  // never exceeded
  double max_seconds = std::numeric_limits<double>::infinity();               // wall clock, of this call [s]
  CmaEsTolerances tolerances = {};
  NoiseOptions noise = {};  // for noisy objectives only

  /// Called after every generation, on the calling thread; what it sees can be saved and resumed from.
  std::function<void(const CmaEsSearch&)> on_progress = {};
};

/// Throws OptimizeError, naming the option, unless all of them make sense.
void check(const CmaEsOptions& options);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/cma_es_options.ipp"
#endif
