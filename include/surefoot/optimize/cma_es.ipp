// Definitions of surefoot/optimize/cma_es.hpp.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <utility>

#include "surefoot/core/box.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/cma_es.hpp"
#include "surefoot/optimize/cma_es_core.hpp"
#include "surefoot/optimize/cma_es_options.hpp"
#include "surefoot/optimize/cma_es_search.hpp"
#include "surefoot/optimize/search_space.hpp"

namespace surefoot {

SUREFOOT_INLINE CmaEsSearch cma_es_search(const Eigen::VectorXd& start, double sigma,
                                          const std::optional<Box<Eigen::Dynamic>>& box, const CmaEsOptions& options,
                                          std::uint64_t seed) {
  check(options);
  const Eigen::VectorXd from = SearchSpace(box).to_search(start);
  const Eigen::Index population = options.population != 0 ? options.population : default_population(from.size());
  CmaEsSearch search;
  search.start = start;
  search.sigma = sigma;
  search.box = box;
  search.seed = seed;
  search.state = cma_es_start(from, sigma, population, seed);
  search.plan.population = population;
  search.schedule.first_population = population;
  search.schedule.large_population = population;
  search.descent.population = population;
  search.noise_evaluations = options.noise.evaluations;
  return search;
}

}  // namespace surefoot
