// Tunes the parameters of any policy by CMA-ES on its simulated cost.
//
// The candidates of a generation meet the same starts and noise (common random numbers), the next generation meets
// others. A candidate is first judged by few runs; the number grows where the order of the candidates is more luck than
// merit (rank_noise.hpp). BIPOP restarts leave poor local optima. At the end every descent enters the center of its
// distribution and its best candidate, the start joins them, and the one with the best mean over many fresh runs wins.
// Cost: that of the simulated runs.
//
//   auto make_policy = [](const surefoot::Vec<2>& gains) { return Pd(gains); };
//   auto result = surefoot::policy_search(problem, make_policy, start, box, {}, surefoot::Threads{}, /*seed*/ 1);
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <stop_token>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "surefoot/core/box.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/policy.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/optimize/cma_es.hpp"
#include "surefoot/solve/rfpi_options.hpp"

namespace surefoot {

struct PolicySearchOptions {
  int horizon = 50;       // [transitions] of every run
  double discount = 1.0;  // per transition

  int min_runs = 50;                       // of each candidate, at first; rounded down to even
  int max_runs = 400;                      // of each candidate, where noise hides which is better
  std::uint64_t total_runs = 5'000'000;    // budget of the search
  double max_seconds = std::numeric_limits<double>::infinity();  // another one, wall clock: if it strikes, the result
                                                                 // depends on the speed of the machine [s]
  int final_runs = 10'000;  // of each finalist, on top of the budget

  Eigen::Index population = 0;  // candidates of a generation; 0: twice the default of CMA-ES
  double sigma = 0.3;           // first standard deviation [widths of the box]
  double precision = 1e-3;      // a descent ends at this standard deviation [first standard deviations]
  Restarts restarts = Restarts::bipop;
  int max_restarts = 9;  // with large population

  /// Called after every generation. Values in it are costs, minus the mean return; an evaluation is min_runs / 2 runs.
  std::function<void(const CmaEsSearch&)> observer = {};
};

/// Throws SolveError, naming the option, unless those of the search make sense.
inline void check(const PolicySearchOptions& options, Eigen::Index population) {
  const auto demand = [](bool condition, const std::string& sentence) {
    if (!condition) throw SolveError("PolicySearchOptions: " + sentence);
  };
  demand(options.min_runs >= 2, "min_runs must be at least 2");
  demand(options.max_runs >= options.min_runs, "max_runs must be at least min_runs");
  demand(options.final_runs >= 1, "final_runs must be at least 1");
  const std::uint64_t generation = static_cast<std::uint64_t>(options.min_runs) * static_cast<std::uint64_t>(population);
  demand(options.total_runs >= generation,
         "total_runs must cover the first generation, " + std::to_string(generation) + " runs");
}

/// A point of the search and its mean return over fresh runs.
template <int N>
struct PolicySearchFinalist {
  Vec<N> parameters;
  Estimate value;
};

template <int N>
struct PolicySearchResult {
  Vec<N> parameters;  // of the best finalist
  Estimate value;     // its mean return over final_runs runs that had no part in choosing it
  std::vector<PolicySearchFinalist<N>> finalists;  // the start, then center and best candidate of every descent
  StopReason reason = StopReason::stop_requested;
  std::uint64_t runs = 0;  // of the search, without the finals
  double seconds = 0;      // wall clock, finals included [s]
};

/// Searches the box, from `start` in it. `make_policy` maps parameters, a Vec<N>, to a policy of `problem`. `stop` ends
/// the search; the finals are still run. Same seed, same bits on any executor, unless max_seconds strikes.
template <Problem P, int N, std::invocable<const Vec<N>&> MakePolicy, Executor E>
  requires Policy<std::invoke_result_t<const MakePolicy&, const Vec<N>&>, P>
PolicySearchResult<N> policy_search(const P& problem, const MakePolicy& make_policy,
                                    const std::type_identity_t<Vec<N>>& start, const Box<N>& box,
                                    const PolicySearchOptions& options, const E& executor, std::uint64_t seed,
                                    std::stop_token stop = {}) {
  const auto began = std::chrono::steady_clock::now();
  const Eigen::Index population = options.population != 0 ? options.population : 2 * default_population(box.size());
  check(options, population);
  const int runs_per_call = options.min_runs / 2;  // two calls at least: rank_disorder() compares halves
  const RolloutOptions brief{.runs = runs_per_call, .horizon = options.horizon, .discount = options.discount};
  const RolloutOptions thorough{.runs = options.final_runs, .horizon = options.horizon, .discount = options.discount};
  const auto cost = [&](const Eigen::VectorXd& parameters, Rng& rng) {
    return -evaluate(problem, make_policy(Vec<N>(parameters)), brief, Serial{}, rng.bits()).mean;
  };

  CmaEsOptions search;
  search.box_sigma = options.sigma;
  search.population = population;
  search.restarts = options.restarts;
  search.max_restarts = options.max_restarts;
  search.max_evaluations = options.total_runs / static_cast<std::uint64_t>(runs_per_call);
  search.max_seconds = options.max_seconds;
  search.tolerances.x = options.precision;
  search.noise = {.evaluations = 2, .max_evaluations = options.max_runs / runs_per_call};
  search.observer = options.observer;
  const Box<Eigen::Dynamic> bounds{Eigen::VectorXd(box.low()), Eigen::VectorXd(box.high())};
  const CmaEsResult found =
      cma_es(cost, Eigen::VectorXd(start), bounds, search, executor, Rng(seed, 0).bits(), std::move(stop));

  PolicySearchResult<N> result{.parameters = start,
                               .value = {},
                               .finalists = {},
                               .reason = found.reason,
                               .runs = found.evaluations * static_cast<std::uint64_t>(runs_per_call)};
  const auto enter = [&](const Vec<N>& parameters) {
    const Estimate value = evaluate(problem, make_policy(parameters), thorough, executor, Rng(seed, 1).bits());
    result.finalists.push_back({parameters, value});
  };
  enter(start);
  for (const CmaEsDescent& descent : found.descents) {
    enter(descent.mean);
    enter(descent.best);
  }
  result.parameters = std::ranges::max_element(result.finalists, {}, [](const auto& finalist) {
                        return finalist.value.mean;
                      })->parameters;
  result.value = evaluate(problem, make_policy(result.parameters), thorough, executor, Rng(seed, 2).bits());
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return result;
}

}  // namespace surefoot
