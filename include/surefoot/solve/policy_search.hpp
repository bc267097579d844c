// Tunes the parameters of any policy by CMA-ES on its simulated cost.
//
// Two stages, each with half of the budget. The first explores: descents by few runs per candidate, restarted (BIPOP)
// to leave poor local optima. The second refines the best center that was found, with more runs per candidate where the
// order of the candidates is more luck than merit (rank_noise.hpp). In both the candidates of a generation meet the
// same starts and noise (common random numbers), and the next generation meets others. At the end the start, the center
// of every descent and the best candidate of the last stage are compared on many fresh runs. Cost: that of the
// simulated runs.
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

  int min_runs = 50;                     // of each candidate while exploring; rounded down to even
  int max_runs = 400;                    // of each candidate while refining, where noise hides which is better
  std::uint64_t total_runs = 3'000'000;  // budget of the search
  double max_seconds = std::numeric_limits<double>::infinity();  // another one, wall clock: if it strikes, the result
                                                                 // depends on the speed of the machine [s]
  int final_runs = 10'000;                                       // of each finalist, on top of the budget

  Eigen::Index population = 0;  // candidates of a generation; 0: twice the default of CMA-ES
  double sigma = 0.3;           // first standard deviation while exploring [widths of the box]
  double refine_sigma = 0.05;   // first standard deviation while refining [widths of the box]
  double precision = 1e-3;      // a descent ends at this standard deviation [first standard deviations]
  Restarts restarts = Restarts::bipop;
  int max_restarts = 9;  // with large population

  /// Called after every generation. Values in it are costs, minus the mean return; an evaluation is min_runs / 2 runs.
  std::function<void(const CmaEsSearch&)> on_progress = {};
};

/// Throws SolveError, naming the option, unless those of the search make sense.
inline void check(const PolicySearchOptions& options, Eigen::Index population) {
  const auto demand = [](bool condition, const std::string& sentence) {
    if (!condition) throw SolveError("PolicySearchOptions: " + sentence);
  };
  demand(options.min_runs >= 2, "min_runs must be at least 2");
  demand(options.max_runs >= options.min_runs, "max_runs must be at least min_runs");
  demand(options.final_runs >= 1, "final_runs must be at least 1");
  const std::uint64_t generation =
      static_cast<std::uint64_t>(options.min_runs) * static_cast<std::uint64_t>(population);
  demand(options.total_runs >= 2 * generation,
         "total_runs must cover a generation of both stages, " + std::to_string(2 * generation) + " runs");
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
  std::vector<PolicySearchFinalist<N>> finalists;  // the start, the center of every descent, the best candidate
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
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); };
  const auto stage_seed = [seed](int stage) { return Rng(seed, stage).bits(); };
  const Eigen::Index population = options.population != 0 ? options.population : 2 * default_population(box.size());
  check(options, population);
  const int runs_per_call = options.min_runs / 2;  // two calls at least: rank_disorder() compares halves
  const auto rollouts = [&](int runs) {
    return RolloutOptions{.runs = runs, .horizon = options.horizon, .discount = options.discount};
  };
  const auto cost = [&, brief = rollouts(runs_per_call)](const Eigen::VectorXd& parameters, Rng& rng) {
    return -evaluate(problem, make_policy(Vec<N>(parameters)), brief, Serial{}, rng.bits()).mean;
  };

  PolicySearchResult<N> result{.parameters = start, .value = {}, .finalists = {{start, {}}}};
  const auto judge = [&](int runs, std::uint64_t judge_seed) {  // all finalists so far; the best wins
    for (auto& finalist : result.finalists) {
      finalist.value = evaluate(problem, make_policy(finalist.parameters), rollouts(runs), executor, judge_seed);
    }
    const auto mean = [](const auto& finalist) { return finalist.value.mean; };
    result.parameters = std::ranges::max_element(result.finalists, {}, mean)->parameters;
  };
  const auto search = [&](CmaEsOptions stage, std::uint64_t runs, int number) {
    stage.population = population;
    stage.max_evaluations = runs / static_cast<std::uint64_t>(runs_per_call);
    stage.tolerances.x = options.precision;
    stage.on_progress = options.on_progress;
    const Box<Eigen::Dynamic> bounds{Eigen::VectorXd(box.low()), Eigen::VectorXd(box.high())};
    const CmaEsResult found =
        cma_es(cost, Eigen::VectorXd(result.parameters), bounds, stage, executor, stage_seed(number), stop);
    for (const CmaEsDescent& descent : found.descents) result.finalists.push_back({descent.mean, {}});
    if (found.best.size() > 0) result.finalists.push_back({found.best, {}});
    result.runs += found.evaluations * static_cast<std::uint64_t>(runs_per_call);
    result.reason = found.reason;
  };

  CmaEsOptions explore{.box_sigma = options.sigma, .restarts = options.restarts, .max_restarts = options.max_restarts};
  explore.max_seconds = 0.5 * options.max_seconds;
  explore.noise = {.evaluations = 2, .max_evaluations = 2};
  search(explore, options.total_runs / 2, 0);
  judge(5 * options.max_runs, stage_seed(1));

  CmaEsOptions refine{.box_sigma = options.refine_sigma};
  refine.max_seconds = std::max(0.0, options.max_seconds - seconds());
  refine.noise = {.evaluations = 2, .max_evaluations = options.max_runs / runs_per_call};
  if (!in_any_process(executor, stop.stop_requested())) search(refine, options.total_runs - result.runs, 2);
  judge(options.final_runs, stage_seed(3));
  result.value =
      evaluate(problem, make_policy(result.parameters), rollouts(options.final_runs), executor, stage_seed(4));
  result.seconds = seconds();
  return result;
}

/// For a type that is not a Problem: one compile error that names the missing member.
template <class P, int N>
  requires(!Problem<P>)
auto policy_search(const P&, const auto&, const std::type_identity_t<Vec<N>>&, const Box<N>&,
                   const PolicySearchOptions&, auto&&...) {
  return explain_problem<P>();
}

}  // namespace surefoot
