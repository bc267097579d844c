// CMA-ES, a search for the minimum of a function of a few to some hundred variables by its values alone, with bounds,
// noise and restarts. Hansen: "The CMA Evolution Strategy: A Tutorial", arXiv:1604.00772; see cma_es_core.hpp,
// search_space.hpp (bounds), restarts.hpp (IPOP, BIPOP), rank_noise.hpp (noise) and cma_es_stop.hpp (stop criteria).
//
//   const auto f = [](const Eigen::VectorXd& x) { return x.squaredNorm(); };
//   const auto result = surefoot::cma_es(f, start, 0.5, {.target = 1e-9}, surefoot::Serial{}, /*seed*/ 1);
//
// The candidates of a generation are evaluated at once on the executor, and the result has the same bits on any. Cost
// besides the objective: about 0.2, 0.4, 1.5 us per evaluation in 6, 12, 40 dimensions.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <utility>

#include "surefoot/core/box.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/optimize/cma_es_constants.hpp"
#include "surefoot/optimize/cma_es_loop.hpp"
#include "surefoot/optimize/cma_es_options.hpp"
#include "surefoot/optimize/cma_es_search.hpp"
#include "surefoot/optimize/objective.hpp"

namespace surefoot {

/// A search that has not begun. With a box, `sigma` is in widths of the box.
CmaEsSearch cma_es_search(const Eigen::VectorXd& start, double sigma, const std::optional<Box<Eigen::Dynamic>>& box,
                          const CmaEsOptions& options, std::uint64_t seed);

/// Goes on with a search, with the same objective and options as before except for target and budgets: then it ends in
/// the same bits as one that was never interrupted.
template <Objective F, Executor E>
CmaEsResult cma_es(const F& objective, CmaEsSearch search, const CmaEsOptions& options, const E& executor,
                   std::stop_token stop = {}) {
  check(options);
  const detail::CmaEsEnvironment environment{
      .evaluate = [&](detail::CmaEsGeneration& g) { return detail::evaluate_generation(objective, g, executor, stop); },
      .in_any_process = [&](bool flag) { return in_any_process(executor, flag); },
      .once = [&](const std::function<void()>& job) { once(executor, job); },
      .stop = stop,
      .noisy = NoisyObjective<F>};
  return detail::run_cma_es(std::move(search), options, environment);
}

/// Minimises without bounds, from `start` with standard deviation `sigma` in every coordinate: scale the objective's
/// variables so that the minimum is a few sigmas away in each. Restarts begin at normal draws around `start`.
template <Objective F, Executor E>
CmaEsResult cma_es(const F& objective, const Eigen::VectorXd& start, double sigma, const CmaEsOptions& options,
                   const E& executor, std::uint64_t seed, std::stop_token stop = {}) {
  return cma_es(objective, cma_es_search(start, sigma, std::nullopt, options, seed), options, executor,
                std::move(stop));
}

/// Minimises inside a box, from `start` in it, with first standard deviation options.box_sigma. Every point that is
/// evaluated lies in the box. Restarts begin anywhere in it.
template <Objective F, Executor E>
CmaEsResult cma_es(const F& objective, const Eigen::VectorXd& start, const Box<Eigen::Dynamic>& box,
                   const CmaEsOptions& options, const E& executor, std::uint64_t seed, std::stop_token stop = {}) {
  return cma_es(objective, cma_es_search(start, options.box_sigma, box, options, seed), options, executor,
                std::move(stop));
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/cma_es.ipp"
#endif
