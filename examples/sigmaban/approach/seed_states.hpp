// The states that RFPI begins with.
#pragma once

#include <cstdint>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/rollout.hpp"
#include "winner2016.hpp"

namespace sigmaban {

/// All states of 25 runs of the expert policy Winner2016, as in the paper.
template <class Problem>
std::vector<typename Problem::State> seed_states(const Problem& problem, std::uint64_t seed) {
  std::vector<typename Problem::State> states;
  for (int i = 0; i < 25; ++i) {
    const surefoot::Rng rng(seed, i);
    surefoot::Rng start = rng.stream(0);
    const auto run =
        surefoot::trajectory(problem, Winner2016(), problem.initial_state(start), Problem::horizon, rng.stream(1));
    states.insert(states.end(), run.states.begin(), run.states.end() - (run.terminal ? 1 : 0));
  }
  return states;
}

}  // namespace sigmaban
