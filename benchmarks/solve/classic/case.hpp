// A problem of the suite behind one face, so that each is compiled by itself.
#pragma once

#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "references/reference.hpp"
#include "surefoot/solve/rfpi.hpp"

namespace classic {

/// What one training gave.
struct Training {
  surefoot::Estimate estimate;  // mean return from the fixed starts
  std::vector<surefoot::RfpiProgress> history;
  double cpu_seconds = 0;
  std::size_t leaves = 0, bytes = 0;
  double decision_ns = 0;  // one action, states of runs one after the other
};

struct Case {
  std::string name;
  int state_dim = 0, action_dim = 0, horizon = 0;
  std::function<Reference()> reference;
  std::function<Training(const surefoot::RfpiOptions&, std::uint64_t seed)> train;
};

inline double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// CPU time of one call of the policy, over states that it visits.
template <surefoot::Problem P>
double decision_ns(const surefoot::ForestPolicy<P>& policy) {
  const auto states = surefoot::visited_states(
      policy.problem(), [&](auto some) { return policy.act(some); }, 32, P::horizon, 0.0, surefoot::Serial{},
      surefoot::Rng(1));
  double sum = 0;
  std::size_t calls = 0;
  const double start = cpu_seconds();
  while (cpu_seconds() - start < 0.1) {
    for (const auto& state : states) sum += policy(state)[0];
    calls += states.size();
  }
  [[maybe_unused]] volatile double kept = sum;
  return 1e9 * (cpu_seconds() - start) / static_cast<double>(calls);
}

template <surefoot::Problem P>
Case case_of(const char* name) {
  const auto train = [](surefoot::RfpiOptions options, std::uint64_t seed) {
    const P problem;
    options.horizon = P::horizon;
    Training training;
    const double start = cpu_seconds();
    const auto result = surefoot::rfpi(problem, options, surefoot::Serial{}, seed);
    training.cpu_seconds = cpu_seconds() - start;
    training.history = result.history;
    training.estimate = evaluated(problem, result.policy);
    training.leaves = result.policy.forest().leaves();
    training.bytes = result.policy.forest().bytes();
    training.decision_ns = decision_ns(result.policy);
    return training;
  };
  return {name, P::state_dim, P::action_dim, P::horizon, [] { return P{}.reference(); }, train};
}

/// All problems of the suite.
std::vector<Case> all_cases();

}  // namespace classic
