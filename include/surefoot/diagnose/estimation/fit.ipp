// Definitions of surefoot/diagnose/estimation/fit.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/residuals.hpp"
#include "surefoot/optimize/least_squares.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Parallel serially() {
  return [](std::size_t count, FunctionRef<void(std::size_t)> job) {
    for (std::size_t i = 0; i < count; ++i) job(i);
  };
}

SUREFOOT_ONCE FitProblem without_prior(FitProblem problem) {
  problem.prior.resize(0);
  return problem;
}

SUREFOOT_ONCE FitFunctions::FitFunctions(const BoundSimulator& bound, const Hypothesis& start,
                                         const FitProblem& problem, const Parallel& parallel)
    : bound_(bound), base_(start), problem_(problem), parallel_(parallel) {
  variables_ = variables_of(bound, start, problem.recordings, problem.free);
  shared_ =
      static_cast<std::size_t>(count_items(variables_, [](const Variable& v) { return !is_of_one_recording(v); }));
  begin_.push_back(0);
  for (const std::size_t r : problem.recordings) {
    cells_.push_back(cells_of(bound.recordings[r]));
    begin_.push_back(begin_.back() + static_cast<Eigen::Index>(cells_.back().size()));
  }
  prior_ = prior_rows(variables_, problem.prior);
}

SUREFOOT_ONCE Eigen::VectorXd FitFunctions::start() const {
  Eigen::VectorXd z(static_cast<Eigen::Index>(variables_.size()));
  Hypothesis copy = base_;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    z[static_cast<Eigen::Index>(i)] =
        to_search(variables_[i], std::clamp(value_of(copy, variables_[i]), variables_[i].low, variables_[i].high));
  }
  return z;
}

SUREFOOT_ONCE Box<Eigen::Dynamic> FitFunctions::box() const {
  Eigen::VectorXd low(static_cast<Eigen::Index>(variables_.size())), high = low;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    low[static_cast<Eigen::Index>(i)] = to_search(variables_[i], variables_[i].low);
    high[static_cast<Eigen::Index>(i)] = to_search(variables_[i], variables_[i].high);
  }
  return {low, high};
}

SUREFOOT_INLINE Hypothesis FitFunctions::at(const Eigen::VectorXd& z) const {
  Hypothesis hypothesis = base_;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    value_of(hypothesis, variables_[i]) = from_search(variables_[i], z[static_cast<Eigen::Index>(i)]);
  }
  return hypothesis;
}

SUREFOOT_INLINE Eigen::VectorXd FitFunctions::residuals(const Eigen::VectorXd& z) const {
  Eigen::VectorXd all = residuals_at(at(z));
  for (Eigen::Index k = 0; k < prior_.mean.size(); ++k) {
    all[begin_.back() + k] = prior_.slope[k] * (z[k] - prior_.mean[k]);
  }
  return all;
}

SUREFOOT_INLINE Eigen::VectorXd FitFunctions::residuals_at(const Hypothesis& hypothesis) const {
  Eigen::VectorXd all(begin_.back() + prior_.mean.size());
  parallel_(cells_.size(), [&](std::size_t i) {
    const Eigen::VectorXd one = residuals_of(hypothesis, i);
    std::copy_n(one.data(), one.size(), all.data() + begin_[i]);
  });
  return all;
}

/// Whether it is a step of a sensor that rounds.
SUREFOOT_ONCE bool is_of_rounding(const Hypothesis& hypothesis, const Variable& variable) {
  return variable.kind == Variable::Kind::effect && hypothesis.effects[variable.index].effect->rounds;
}

SUREFOOT_INLINE Eigen::MatrixXd FitFunctions::differences(const Eigen::VectorXd& z, const Eigen::VectorXd& here,
                                                          bool central) const {
  constexpr double difference = 1e-4;  // in units of the search, about 1e-4 of a variable: between noise and curvature
  const auto columns = static_cast<Eigen::Index>(variables_.size());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(here.size(), columns);
  std::vector<std::pair<std::size_t, std::size_t>> jobs;  // variable, place of a recording
  for (std::size_t v = 0; v < variables_.size(); ++v) {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (v < shared_ || variables_[v].item == problem_.recordings[i]) jobs.emplace_back(v, i);
    }
  }
  const bool rounds = holds_for_any(base_.effects, [](const AttachedEffect& one) { return one.effect->rounds; });
  const Eigen::VectorXd smooth = rounds ? residuals_at(without_rounding(at(z))) : Eigen::VectorXd();
  parallel_(jobs.size(), [&](std::size_t j) {
    const auto [v, i] = jobs[j];
    const bool as_read = !rounds || is_of_rounding(base_, variables_[v]);
    const auto moved_to = [&, i = i](const Eigen::VectorXd& to) {
      return residuals_of(as_read ? at(to) : without_rounding(at(to)), i);
    };
    const auto k = static_cast<Eigen::Index>(v);
    const double low = to_search(variables_[v], variables_[v].low), high = to_search(variables_[v], variables_[v].high);
    const double step = z[k] + 2 * difference > high ? -difference : difference;
    const bool both_sides = central && z[k] - difference > low && z[k] + difference < high;
    Eigen::VectorXd moved = z;
    moved[k] = z[k] + step;
    const Eigen::Index length = begin_[i + 1] - begin_[i];
    const Eigen::VectorXd there = moved_to(moved);
    moved[k] = z[k] - step;
    const Eigen::VectorXd back = both_sides ? moved_to(moved) : Eigen::VectorXd();
    for (Eigen::Index n = 0; n < length; ++n) {
      const double behind = both_sides ? back[n] : (as_read ? here : smooth)[begin_[i] + n];
      jacobian(begin_[i] + n, k) = (there[n] - behind) / (both_sides ? 2 * step : step);
    }
  });
  for (Eigen::Index k = 0; k < prior_.slope.size(); ++k) jacobian(begin_.back() + k, k) = prior_.slope[k];
  for (Eigen::Index i = 0; i < jacobian.size(); ++i) {
    if (!std::isfinite(jacobian.data()[i])) jacobian.data()[i] = 0;
  }
  return jacobian;
}

SUREFOOT_INLINE Eigen::VectorXd FitFunctions::residuals_of(const Hypothesis& hypothesis, std::size_t i) const {
  const std::size_t r = problem_.recordings[i];
  return weighted_residuals(bound_, r, simulate(bound_, hypothesis, r, problem_.integration), cells_[i],
                            problem_.weighting);
}

SUREFOOT_INLINE double mean_loss(const Eigen::VectorXd& residuals, double robust) {
  if (residuals.size() == 0) return 0;
  double sum = 0;
  for (const double r : residuals) sum += robust * robust * loss_terms(Loss::huber, r / robust).rho;
  return sum / static_cast<double>(residuals.size());
}

SUREFOOT_ONCE double loss_of(const BoundSimulator& bound, const Hypothesis& hypothesis, const FitProblem& problem,
                             const Parallel& parallel) {
  const FitFunctions functions(bound, hypothesis, problem, parallel);
  return mean_loss(functions.residuals(functions.start()), problem.weighting.robust);
}

SUREFOOT_INLINE bool comes_nearer(double before, double now, double reach) {
  constexpr double a_start = 0.1;  // of the way
  return now < before * std::pow(std::min(1.0, reach / before), a_start);
}

/// A fit and its residuals, recording after recording.
struct Descent {
  Fit fit;
  Eigen::VectorXd residuals;
};

/// One descent, from the parameters of `start` on.
SUREFOOT_ONCE Descent descend(const BoundSimulator& bound, const Hypothesis& start, const FitProblem& problem,
                              const Parallel& parallel) {
  const FitFunctions functions(bound, start, problem, parallel);
  Descent result{Fit{.hypothesis = start}, {}};
  const Eigen::VectorXd z = functions.start();
  if (!all_finite(z)) return result;
  const Eigen::VectorXd first = result.residuals = functions.residuals(z);
  result.fit.loss = mean_loss(first, problem.weighting.robust);
  if (!all_finite(first) || first.size() == 0) return result;
  result.fit.ok = true;
  if (functions.variables().empty()) return result;
  LeastSquaresOptions options;
  options.box = functions.box();
  options.loss = Loss::huber;
  options.loss_scale = problem.weighting.robust;
  options.max_iterations = problem.max_iterations;
  options.tol_cost = problem.tolerance;
  options.tol_step = 1e-6;
  options.secant_steps = problem.secant_steps;
  options.covariance = false;
  Eigen::VectorXd asked = z, there = first;  // the last point, whose residuals the Jacobian needs again
  const auto residuals = [&](const Eigen::VectorXd& x) -> const Eigen::VectorXd& {
    if (!std::equal(x.begin(), x.end(), asked.begin())) {
      there = functions.residuals(x);
      asked = x;
    }
    return there;
  };
  std::vector<double> losses;  // by iteration
  options.on_progress = [&](int, double cost) { losses.push_back(cost / (0.5 * static_cast<double>(first.size()))); };
  const auto lost = [&] {
    constexpr std::size_t a_few = 4;
    const std::size_t count = losses.size();
    return problem.reach > 0 && count > a_few && !comes_nearer(losses[count - 1 - a_few], losses.back(), problem.reach);
  };
  const auto jacobian = [&](const Eigen::VectorXd& x) -> Eigen::MatrixXd {
    const bool ends = problem.stopped() || lost();
    if (ends) return Eigen::MatrixXd::Zero(first.size(), x.size());  // nothing to gain
    return functions.jacobian(x, residuals(x));
  };
  const auto fitted = least_squares(residuals, z, options, jacobian);
  result.fit.hypothesis = functions.at(fitted.x);
  result.fit.loss = mean_loss(fitted.residuals, problem.weighting.robust);
  result.residuals = fitted.residuals;
  return result;
}

/// Whether effects begin anywhere in each recording.
SUREFOOT_ONCE bool effects_begin_anywhere(const Hypothesis& hypothesis) {
  return holds_for_any(hypothesis.effects, [](const AttachedEffect& one) { return one.effect->starts_anywhere; });
}

/// Other beginnings of a recording: unknown states as were read off it; and effects that a fit left settled in places
/// all over their range, since what a limit or a gap forgets within the first row has no slope.
SUREFOOT_ONCE std::vector<Hypothesis> other_beginnings(const BoundSimulator& bound, const Hypothesis& fitted,
                                                       std::size_t r) {
  constexpr int parts = 4;  // of the range: few, since each of their ends is simulated
  std::vector<Hypothesis> others;
  if (has_unknown_initial_state(bound.recordings[r])) {
    others.push_back(fitted);
    others.back().initial[r] = bound.recordings[r].initial;
  }
  if (!effects_begin_anywhere(fitted)) return others;
  Hypothesis other = fitted;
  for (const Variable& variable : variables_of(bound, fitted, {r}, Free::initial_only)) {
    if (variable.kind != Variable::Kind::start || value_of(other, variable) != 0) continue;
    for (int part = 0; part <= parts; ++part) {
      others.push_back(fitted);
      value_of(others.back(), variable) = variable.low + part * (variable.high - variable.low) / parts;
    }
  }
  return others;
}

/// A fitted hypothesis with other beginnings of recordings, where these fit better; none where they do so nowhere.
SUREFOOT_ONCE std::optional<Hypothesis> begun_otherwise(const BoundSimulator& bound, const Descent& fitted,
                                                        const FitProblem& problem, const Parallel& parallel) {
  const std::size_t count = problem.recordings.size();
  std::vector<Eigen::Index> begin{0};
  for (const std::size_t r : problem.recordings) {
    begin.push_back(begin.back() + static_cast<Eigen::Index>(cells_of(bound.recordings[r]).size()));
  }
  std::vector<Hypothesis> better(count);  // without initial states: none
  parallel(count, [&](std::size_t i) {
    const std::size_t r = problem.recordings[i];
    const std::vector<Cell> cells = cells_of(bound.recordings[r]);
    Eigen::VectorXd here(static_cast<Eigen::Index>(cells.size()));
    std::copy_n(fitted.residuals.data() + begin[i], here.size(), here.data());
    double least = mean_loss(here, problem.weighting.robust);
    for (Hypothesis& other : other_beginnings(bound, fitted.fit.hypothesis, r)) {
      const SimulatedRun run = simulate(bound, other, r, problem.integration);
      const double loss =
          mean_loss(weighted_residuals(bound, r, run, cells, problem.weighting), problem.weighting.robust);
      if (!(loss < least)) continue;
      least = loss;
      better[i] = std::move(other);
    }
  });
  Hypothesis result = fitted.fit.hypothesis;
  bool any = false;
  for (std::size_t i = 0; i < count; ++i) {
    if (better[i].initial.empty()) continue;
    any = true;
    const std::size_t r = problem.recordings[i];
    result.initial[r] = better[i].initial[r];
    for (std::size_t e = 0; e < result.effects.size(); ++e) {
      const Effect& effect = *result.effects[e].effect;
      const auto start = static_cast<Eigen::Index>(effect.parameters.size() + r);
      if (effect.starts_anywhere) result.values[e][start] = better[i].values[e][start];
    }
  }
  if (!any) return std::nullopt;
  return result;
}

SUREFOOT_ONCE Fit fit(const BoundSimulator& bound, const Hypothesis& start, const FitProblem& problem,
                      const Parallel& parallel) {
  const Descent first = descend(bound, start, problem, parallel);
  if (!first.fit.ok || problem.stopped()) return first.fit;
  const std::optional<Hypothesis> elsewhere = begun_otherwise(bound, first, problem, parallel);
  if (!elsewhere) return first.fit;
  const Fit again = descend(bound, *elsewhere, problem, parallel).fit;
  return again.ok && again.loss < first.fit.loss ? again : first.fit;
}

SUREFOOT_ONCE void fit_each(const BoundSimulator& bound, std::vector<Fit>& fits, const FitProblem& problem,
                            const Parallel& parallel) {
  parallel(fits.size(), [&](std::size_t i) {
    if (!problem.stopped()) fits[i] = fit(bound, fits[i].hypothesis, problem, serially());
  });
}

SUREFOOT_ONCE Hypothesis with_estimated_initial_states(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                       const std::vector<std::size_t>& recordings, FitProblem problem,
                                                       const Parallel& parallel) {
  if (!effects_begin_anywhere(hypothesis) && !has_unknown_initial_state(bound, recordings)) return hypothesis;
  problem.recordings = recordings;
  problem.free = Free::initial_only;
  return fit(bound, hypothesis, problem, parallel).hypothesis;
}

}  // namespace surefoot::diagnosis
