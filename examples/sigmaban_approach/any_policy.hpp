// Any policy that the command line can name: Winner2016 with some parameters, or a forest.
#pragma once

#include <string>
#include <variant>

#include "approach.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "winner2016.hpp"

namespace sigmaban {

using AnyPolicy = std::variant<Winner2016, surefoot::ForestPolicy<Approach>>;

/// "winner2016", "tuned" (the parameters in the public history of the paper's authors), a parameter file of `tune`,
/// or a policy file of `train`. Throws surefoot::Error if the file is none of these.
AnyPolicy load_any_policy(const Approach& problem, const std::string& name_or_file);

/// The mean cost of independent runs.
surefoot::Estimate mean_cost(const Approach& problem, const AnyPolicy& policy, int trials, std::uint64_t seed,
                             const surefoot::Threads& threads);

/// The seed of the runs that `evaluate` and `table` make unless told otherwise.
inline constexpr std::uint64_t evaluation_seed = 2016;

}  // namespace sigmaban
