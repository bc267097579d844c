// Proves a diagnosis on recordings that were used neither to fit nor to choose (they may veto, see confirm.hpp): errors
// before and after, against the noise and against a forest in place of physics.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/residual_tests/forest_correction.hpp"
#include "surefoot/diagnose/residual_tests/mismatch.hpp"
#include "surefoot/diagnose/verdict/investigation.hpp"

namespace surefoot::diagnosis {

/// Executor on top of Parallel, for the forest.
struct ParallelExecutor {
  const Parallel* parallel;
  std::size_t width() const { return 1; }
  template <class Job>
  bool run(std::size_t count, Job&& job, std::stop_token = {}) const {
    (*parallel)(count, [&](std::size_t i) { job(i); });
    return true;
  }
};

/// Errors on the test recordings, of which both hypotheses need the initial states: whole recordings are simulated,
/// whatever the fit did.
void prove(Investigation& investigation, const Hypothesis& calibrated, const Hypothesis& chosen,
           const Parallel& parallel, std::uint64_t seed);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/evaluate.ipp"
#endif
