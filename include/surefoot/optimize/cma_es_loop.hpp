// The loop behind cma_es(): generations, learning, stops and restarts, for objectives and executors of any type.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/optimize/cma_es_options.hpp"
#include "surefoot/optimize/cma_es_search.hpp"
#include "surefoot/optimize/objective.hpp"

namespace surefoot::detail {

/// The candidates of a generation and what they are worth.
struct CmaEsGeneration {
  std::vector<Eigen::VectorXd> points;  // in the user's coordinates
  std::uint64_t repetitions = 1;        // evaluations of each, of a noisy objective
  bool common_random_numbers = true;
  Rng rng{0};
  std::vector<double> values;                   // by candidate: means of the repetitions
  std::vector<double> first_half, second_half;  // by candidate: sums over the halves of the repetitions
};

/// What the loop needs of the types of the user.
struct CmaEsEnvironment {
  std::function<bool(CmaEsGeneration&)> evaluate;  // false if a stop came before all candidates were done
  std::function<bool(bool)> in_any_process;
  std::function<void(const std::function<void()>&)> once;
  std::stop_token stop;
  bool noisy = false;
};

/// Evaluates the candidates on an executor.
template <Objective F, Executor E>
bool evaluate_generation(const F& objective, CmaEsGeneration& generation, const E& executor,
                         const std::stop_token& stop) {
  const auto job = [&](std::size_t i) {
    if constexpr (ExactObjective<F>) {
      generation.values[i] = objective(std::as_const(generation.points[i]));
    } else {
      const std::uint64_t repetitions = generation.repetitions;
      double sums[2] = {0, 0};
      for (std::uint64_t r = 0; r < repetitions; ++r) {
        Rng own = generation.common_random_numbers ? generation.rng.stream(r) : generation.rng.stream(r, i + 1);
        sums[r < (repetitions + 1) / 2 ? 0 : 1] += objective(std::as_const(generation.points[i]), own);
      }
      generation.first_half[i] = sums[0];
      generation.second_half[i] = sums[1];
      generation.values[i] = (sums[0] + sums[1]) / static_cast<double>(repetitions);
    }
  };
  return fill(executor, generation.points.size(), job, stop, Results<double>{generation.values},
              Results<double>{generation.first_half}, Results<double>{generation.second_half});
}

CmaEsResult run_cma_es(CmaEsSearch search, const CmaEsOptions& options, const CmaEsEnvironment& environment);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/cma_es_loop.ipp"
#endif
