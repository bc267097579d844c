// Definitions of surefoot/diagnose/estimation/restarts.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/restarts.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::vector<Hypothesis> moved_around(const BoundSimulator& bound, const Hypothesis& fitted,
                                                   std::size_t points, std::uint64_t seed) {
  constexpr double most_factor = 2, most_share = 0.5;  // farther off, other starts of the search are nearer
  std::vector<Variable> variables = variables_of(bound, fitted, {});
  drop_items(variables, [](const Variable& one) { return is_of_one_recording(one); });
  std::vector<Hypothesis> places;
  if (variables.empty()) return places;
  Rng rng(seed, 0x4e5au);
  for (std::size_t k = 0; k < points; ++k) {
    Hypothesis moved = fitted;
    for (const Variable& variable : variables) {
      double& value = value_of(moved, variable);
      const double z = to_search(variable, value), draw = rng.uniform(-1, 1);
      const double most = variable.logarithmic ? std::log(most_factor) : most_share * std::abs(z);
      value = from_search(variable, z + most * draw);
    }
    places.push_back(std::move(moved));
  }
  return places;
}

SUREFOOT_ONCE Fit restarted_fit(const BoundSimulator& bound, const Fit& fitted, const FitProblem& problem,
                                const FitProblem& quick, std::size_t points, std::uint64_t seed,
                                const Parallel& parallel) {
  std::vector<Fit> fits;
  for (Hypothesis& place : moved_around(bound, fitted.hypothesis, points, seed)) fits.push_back({std::move(place)});
  fit_each(bound, fits, quick, parallel);
  double least = clearly_less * loss_of(bound, fitted.hypothesis, quick, serially());
  const Fit* best = nullptr;
  for (const Fit& one : fits) {
    if (!one.ok || !(one.loss < least)) continue;
    least = one.loss;
    best = &one;
  }
  if (best == nullptr || problem.stopped()) return fitted;
  Fit elsewhere = fit(bound, best->hypothesis, problem, parallel);
  return elsewhere.ok && elsewhere.loss < clearly_less * fitted.loss ? elsewhere : fitted;
}

}  // namespace surefoot::diagnosis
