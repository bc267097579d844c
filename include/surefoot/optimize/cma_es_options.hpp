// The options of CMA-ES.
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
  std::function<void(const CmaEsSearch&)> observer = {};
};

/// Throws OptimizeError, naming the option, unless all of them make sense.
inline void check(const CmaEsOptions& options) {
  const auto demand = [](bool condition, const char* sentence) {
    if (!condition) throw OptimizeError(std::string("CmaEsOptions: ") + sentence);
  };
  demand(options.box_sigma > 0 && std::isfinite(options.box_sigma), "box_sigma must be positive and finite");
  demand(options.population == 0 || (options.population >= 4 && options.population <= max_population),
         "population must be from 4 to a million, or 0 for the default");
  demand(options.max_restarts >= 0, "max_restarts must not be negative");
  demand(options.population_growth >= 1 && options.population_growth <= 100, "population_growth must be from 1 to 100");
  demand(!std::isnan(options.target), "target must not be NaN");
  demand(options.max_seconds >= 0, "max_seconds must not be negative");
  demand(options.noise.evaluations >= 1 && options.noise.max_evaluations >= 1,
         "noise.evaluations and noise.max_evaluations must be at least 1");
  demand(options.noise.growth >= 1 && std::isfinite(options.noise.growth), "noise.growth must be at least 1");
}

}  // namespace surefoot
