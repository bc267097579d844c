// Restarts of CMA-ES: the next descent when one has converged and the minimum may be elsewhere.
// IPOP: Auger, Hansen: "A restart CMA evolution strategy with increasing population size", CEC 2005.
// BIPOP: Hansen: "Benchmarking a BI-population CMA-ES on the BBOB-2009 function testbed", GECCO 2009.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "surefoot/core/rng.hpp"
#include "surefoot/optimize/cma_es_state.hpp"

namespace surefoot {

enum class Restarts : std::uint8_t {
  none,
  ipop,   // every descent with a larger population than the one before
  bipop,  // these take turns with descents of small population and small sigma, at equal total evaluations
};

/// Population, sigma and limit of one descent.
struct DescentPlan {
  Eigen::Index population = 0;
  double sigma_factor = 1;  // of the first descent's sigma
  std::uint64_t max_evaluations = std::numeric_limits<std::uint64_t>::max();
  bool small = false;  // belongs to the small regime of BIPOP
};

/// What has been spent on both regimes so far.
struct RestartSchedule {
  Eigen::Index first_population = 0;
  Eigen::Index large_population = 0;  // of the last descent that was not small
  int large_restarts = 0;
  std::uint64_t large_evaluations = 0;       // of all restarts with large population
  std::uint64_t small_evaluations = 0;       // of all restarts with small population
  std::uint64_t last_large_evaluations = 0;  // of the last descent that was not small

  /// Accounts for descent number `descent` (0 is the first), which followed `plan`.
  void finished(const DescentPlan& plan, std::uint64_t descent, std::uint64_t evaluations) {
    if (plan.small) {
      small_evaluations += evaluations;
    } else {
      last_large_evaluations = evaluations;
      if (descent > 0) large_evaluations += evaluations;
    }
  }

  /// The plan of the next descent; nothing after `max_restarts` restarts with large population. `rng` is used by BIPOP.
  std::optional<DescentPlan> next(Restarts kind, int max_restarts, double growth, Rng rng) {
    if (kind == Restarts::none) return std::nullopt;
    if (kind == Restarts::bipop && small_evaluations < large_evaluations) {
      const double ratio = 0.5 * static_cast<double>(large_population) / static_cast<double>(first_population);
      const double u = rng.uniform();
      const double population = static_cast<double>(first_population) * std::pow(std::max(1.0, ratio), u * u);
      return DescentPlan{.population = static_cast<Eigen::Index>(population),
                         .sigma_factor = std::pow(10, -2 * rng.uniform()),
                         .max_evaluations = std::max<std::uint64_t>(1, last_large_evaluations / 2),
                         .small = true};
    }
    const double larger = std::ceil(growth * static_cast<double>(large_population));
    if (large_restarts >= max_restarts || larger > max_population) return std::nullopt;
    ++large_restarts;
    large_population = static_cast<Eigen::Index>(larger);
    return DescentPlan{.population = large_population};
  }
};

}  // namespace surefoot
