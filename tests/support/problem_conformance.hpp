// What holds for every problem that is fit for use; each problem's tests call it once.
#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <string>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/policy.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/core/validate.hpp"

namespace surefoot::toy {

/// Nothing to complain about but remarks, and the same returns from one thread as from three.
template <Problem P>
void check_problem(const P& problem) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    for (const std::string& complaint : validate(problem, {}, seed)) {
      CAPTURE(complaint);
      CHECK(complaint.starts_with("remark: "));
    }
  }
  const RandomPolicy<P::action_dim> random(problem.action_box());
  const RolloutOptions options{.runs = 200, .horizon = 20};
  CHECK(returns(problem, random, options, Serial{}, 1) == returns(problem, random, options, Threads(3), 1));
}

}  // namespace surefoot::toy
