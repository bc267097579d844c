// `diagnose()`: finds, names and models the physics that a simulator leaves out of what recordings show.
//
// Screens, calibrates, searches for effects, checks them on held-out recordings and decides: verdict/pipeline.hpp is
// the list of stages. All randomness comes from the seed; the result does not depend on the executor.
//
//   const auto diagnosis = surefoot::diagnose(Pendulum{}, recordings, {}, surefoot::Threads{}, 1);
//   // diagnosis.verdict, diagnosis.sentence, diagnosis.effects, ...
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/function_ref.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/options.hpp"
#include "surefoot/diagnose/simulation/bound_simulator.hpp"

namespace surefoot {

namespace diagnosis {

/// All stages of a diagnosis, behind the type of the simulator (verdict/pipeline.hpp).
Diagnosis run_pipeline(const std::function<BoundSimulator(std::vector<Recording>)>& bind, const SimulatorInfo& info,
                       std::vector<Recording> recordings, const DiagnoseOptions& options, const Parallel& parallel,
                       std::uint64_t seed, std::stop_token stop);

}  // namespace diagnosis

/// Diagnoses a simulator against recordings of the machine it is meant to be. Throws DiagnoseError if an option or a
/// recording does not fit. After `stop` is requested it ends soon, with what is known by then (complete = false).
template <class S, Executor E>
Diagnosis diagnose(const S& simulator, std::span<const Recording> recordings, const DiagnoseOptions& options,
                   const E& executor, std::uint64_t seed, std::stop_token stop = {}) {
  static_assert(explain_simulator<S>().empty(), "S is no Simulator; explain_simulator<S>() says what it lacks");
  const auto bind = [&simulator](std::vector<Recording> some) {
    return diagnosis::bind_simulator(simulator, std::move(some));
  };
  const diagnosis::Parallel parallel = [&executor](std::size_t count, FunctionRef<void(std::size_t)> job) {
    executor.run(count, job);
  };
  return diagnosis::run_pipeline(bind, simulator.info(), std::vector<Recording>(recordings.begin(), recordings.end()),
                                 options, parallel, seed, stop);
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/pipeline.hpp"
#endif
