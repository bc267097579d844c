// Definitions of surefoot/solve/policy_search.hpp.
#pragma once

#include <cstdint>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/solve/policy_search.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const PolicySearchOptions& options, Eigen::Index population) {
  const auto demand = [](bool condition, const std::string& sentence) {
    if (!condition) throw SolveError("PolicySearchOptions: " + sentence);
  };
  demand(options.min_runs >= 2, "min_runs must be at least 2");
  demand(options.max_runs >= options.min_runs, "max_runs must be at least min_runs");
  demand(options.final_runs >= 1, "final_runs must be at least 1");
  const std::uint64_t generation =
      static_cast<std::uint64_t>(options.min_runs) * static_cast<std::uint64_t>(population);
  demand(options.total_runs >= 2 * generation,
         "total_runs must cover a generation of both stages, " + std::to_string(2 * generation) + " runs");
}

}  // namespace surefoot
