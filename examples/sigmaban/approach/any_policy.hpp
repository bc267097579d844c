// Any policy that the command line can name: Winner2016 with some parameters, or a forest.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "approach.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "winner2016.hpp"

namespace sigmaban {

template <class Problem>
using AnyPolicyOf = std::variant<Winner2016, surefoot::ForestPolicy<Problem>>;
using AnyPolicy = AnyPolicyOf<Approach>;

/// "winner2016", "tuned" (the parameters in the public history of the paper's authors), or a parameter file of `tune`;
/// none if it is no such thing, but a file. Throws surefoot::Error if there is no such file.
std::optional<Winner2016> load_winner2016(const std::string& name_or_file);

/// One of those, or a policy file of `train`. Throws surefoot::Error if the file is none of these.
template <class Problem>
AnyPolicyOf<Problem> load_any_policy(const Problem& problem, const std::string& name_or_file) {
  if (const auto policy = load_winner2016(name_or_file)) return *policy;
  return surefoot::load_policy<Problem>(problem, name_or_file);
}

/// The mean cost of independent runs.
template <class Problem>
surefoot::Estimate mean_cost(const Problem& problem, const AnyPolicyOf<Problem>& policy, int trials, std::uint64_t seed,
                             const surefoot::Threads& threads) {
  const surefoot::RolloutOptions options{.runs = trials, .horizon = Problem::horizon};
  surefoot::Estimate result =
      std::visit([&](const auto& p) { return surefoot::evaluate(problem, p, options, threads, seed); }, policy);
  result.mean = -result.mean;
  return result;
}

/// The seed of the runs that `evaluate` and `table` make unless told otherwise.
inline constexpr std::uint64_t evaluation_seed = 2016;

}  // namespace sigmaban
