// Definitions of surefoot/optimize/cma_es_options.hpp.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/cma_es_options.hpp"
#include "surefoot/optimize/cma_es_search.hpp"
#include "surefoot/optimize/cma_es_state.hpp"
#include "surefoot/optimize/cma_es_stop.hpp"
#include "surefoot/optimize/objective.hpp"
#include "surefoot/optimize/rank_noise.hpp"
#include "surefoot/optimize/restarts.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const CmaEsOptions& options) {
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
