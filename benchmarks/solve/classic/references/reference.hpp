// What a problem's return is compared with, and the starts that all policies are evaluated from.
#pragma once

#include <cstdint>
#include <string>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rollout.hpp"

namespace classic {

constexpr std::uint64_t evaluation_seed = 20'260'101;  // of the fixed starts

/// A mean return from the fixed starts, and how it was come by.
struct Reference {
  surefoot::Estimate estimate;
  std::string how;
};

/// The mean return of a policy from the fixed starts.
template <surefoot::Problem P, surefoot::Policy<P> F>
surefoot::Estimate evaluated(const P& problem, const F& policy) {
  return surefoot::evaluate(problem, policy, {.runs = P::evaluation_runs, .horizon = P::horizon}, surefoot::Serial{},
                            evaluation_seed);
}

}  // namespace classic
