// Definitions of surefoot/diagnose/estimation/calibrate.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/growing_horizon.hpp"
#include "surefoot/diagnose/estimation/guided_fit.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/estimation/trimmed_fit.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::vector<Hypothesis> scattered(const BoundSimulator& bound, const Hypothesis& around,
                                                std::size_t points, std::uint64_t seed) {
  std::vector<Variable> variables = variables_of(bound, around, {});
  drop_items(variables, [](const Variable& one) { return one.kind != Variable::Kind::parameter; });
  std::vector<Hypothesis> starts;
  if (variables.empty()) return starts;
  Rng rng(seed, 0xca1u);
  for (std::size_t k = 0; k < points; ++k) {
    Hypothesis start = around;
    for (std::size_t i = 0; i < variables.size(); ++i) {
      const double low = to_search(variables[i], variables[i].low), high = to_search(variables[i], variables[i].high);
      // one stratum per point and variable, dealt by a cyclic shift that differs between variables
      const auto cell = static_cast<double>((k * (2 * i + 1) + i) % points);
      const double share = (cell + rng.uniform()) / static_cast<double>(points);
      value_of(start, variables[i]) = from_search(variables[i], low + share * (high - low));
    }
    starts.push_back(std::move(start));
  }
  return starts;
}

SUREFOOT_ONCE Fit scattered_fit(const BoundSimulator& bound, Fit best, const Hypothesis& around,
                                const FitProblem& problem, std::size_t points, std::uint64_t seed,
                                const Parallel& parallel) {
  constexpr std::size_t fitted = 2;  // of the points, those with the lowest losses
  const std::vector<Hypothesis> starts = scattered(bound, around, points, seed);
  std::vector<double> losses(starts.size());
  parallel(starts.size(), [&](std::size_t k) {
    const double loss = loss_of(bound, starts[k], problem, serially());
    losses[k] = std::isfinite(loss) ? loss : std::numeric_limits<double>::infinity();
  });
  const auto lower = [&](std::size_t a, std::size_t b) { return losses[a] < losses[b]; };
  const std::vector<std::size_t> order = sorted_places(starts.size(), lower);
  std::vector<Fit> fits(std::min<std::size_t>(fitted, order.size()));
  for (std::size_t k = 0; k < fits.size(); ++k) fits[k].hypothesis = starts[order[k]];
  fit_each(bound, fits, problem, parallel);
  for (const Fit& other : fits) {
    if (other.ok && other.loss < clearly_less * best.loss) best = other;
  }
  return best;
}

SUREFOOT_ONCE std::vector<double> recording_scales(const BoundSimulator& bound, const FitProblem& problem,
                                                   const std::vector<SimulatedRun>& trajectories) {
  constexpr double least = 1e-3, most = 1e3;  // of a scale's square: no recording alone decides a fit
  std::vector<double> scales(bound.recordings.size(), 1.0);
  Weighting plain = problem.weighting;
  plain.scale.clear();
  for (std::size_t i = 0; i < problem.recordings.size(); ++i) {
    const std::size_t r = problem.recordings[i];
    const Eigen::VectorXd off = weighted_residuals(bound, r, trajectories[i], cells_of(bound.recordings[r]), plain);
    if (off.size() == 0 || !all_finite(off)) continue;
    scales[r] = std::sqrt(std::clamp(std::sqrt(mean_loss(off, plain.robust)), least, most));
  }
  return scales;
}

SUREFOOT_ONCE Fit calibrate(const BoundSimulator& bound, const Hypothesis& nominal, FitProblem& problem,
                            std::size_t points, std::uint64_t seed, const Parallel& parallel) {
  constexpr double least_sigma = 1e-6;  // of the output's standard deviation, where no noise is stated
  constexpr int search_iterations = 30, reweightings = 2, most_reweightings = 5;
  problem.weighting.sigma = output_deviations(bound, problem.recordings);
  Eigen::VectorXd floor = surefoot::detail::times(least_sigma, problem.weighting.sigma);
  for (Eigen::Index k = 0; k < floor.size(); ++k) {
    const double noise = bound.info.outputs[static_cast<std::size_t>(k)].noise;
    if (noise > 0) floor[k] = noise;
  }
  FitProblem first = problem;
  first.max_iterations = search_iterations;
  Fit best = fit(bound, nominal, first, parallel);
  FitProblem on_the_way = first;
  on_the_way.prior = nominal.parameters;
  best = grown_fit(bound, best, nominal, on_the_way, parallel);
  best = guided_fit(bound, best, nominal, on_the_way, parallel);
  best = scattered_fit(bound, best, nominal, first, points, seed, parallel);
  if (!best.ok) {
    throw DiagnoseError(
        "the model cannot be simulated over the recordings with any parameters that were tried: check "
        "its equations, initial values and bounds");
  }
  bool led_out = false;  // of a valley: what is left there asks for other weights
  for (int round = 0; round < reweightings || (led_out && round < most_reweightings); ++round) {
    const auto trajectories = simulate_all(bound, best.hypothesis, problem.recordings, problem.integration, parallel);
    problem.weighting.sigma = residual_sizes(bound, problem.recordings, trajectories);
    for (Eigen::Index k = 0; k < floor.size(); ++k) {
      problem.weighting.sigma[k] = std::max(problem.weighting.sigma[k], floor[k]);
    }
    problem.weighting.scale = recording_scales(bound, problem, trajectories);
    const Fit fitted = fit(bound, best.hypothesis, problem, parallel);
    best = trimmed_fit(bound, fitted, problem, parallel);
    led_out = best.loss < fitted.loss;
  }
  return best;
}

}  // namespace surefoot::diagnosis
