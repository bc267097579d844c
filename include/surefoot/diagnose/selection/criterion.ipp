// Definitions of surefoot/diagnose/selection/criterion.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::size_t EvaluatedHypothesis::parameter_count() const {
  std::size_t count = 0;
  for (const AttachedEffect& one : hypothesis.effects) count += one.effect->parameters.size();
  return count;
}

SUREFOOT_ONCE double least_variance(const SearchProblem& problem) {
  double sum = 0;
  for (Eigen::Index k = 0; k < problem.scale.sigma.size(); ++k) {
    const double ratio = problem.criteria.least_error * problem.scale.sigma[k] / problem.fit.weighting.sigma[k];
    sum += ratio * ratio / static_cast<double>(problem.scale.sigma.size());
  }
  return sum;
}

SUREFOOT_ONCE Eigen::VectorXd pooled(const ErrorSquares& errors) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(errors.counts.cols());
  for (Eigen::Index k = 0; k < result.size(); ++k) {
    double sum = 0, count = 0;
    for (Eigen::Index r = 0; r < errors.counts.rows(); ++r) {
      sum += errors.mean_squares(r, k) * errors.counts(r, k);
      count += errors.counts(r, k);
    }
    if (count > 0) result[k] = sum / count;
  }
  return result;
}

SUREFOOT_ONCE FitProblem screening_fit(const SearchProblem& problem, int iterations) {
  FitProblem quick = problem.fit;
  quick.recordings = problem.screened;
  quick.max_iterations = iterations;
  if (problem.screening && is_finer(quick.integration, *problem.screening)) {
    quick.integration.order = problem.screening->order;
    quick.integration.step = problem.screening->step;
  }
  return quick;
}

SUREFOOT_ONCE Eigen::VectorXd negligible_beside(const ErrorSquares& errors, const SearchProblem& problem) {
  Eigen::VectorXd least = problem.least;
  const Eigen::VectorXd left = pooled(errors);
  const double tolerated = problem.criteria.tolerated_form;
  for (Eigen::Index k = 0; k < std::min(least.size(), problem.noise.size()); ++k) {
    const double noise = problem.noise[k];
    if (noise > 0 && left[k] <= (1 + tolerated) * noise) least[k] = std::min(least[k], tolerated * noise);
  }
  return least;
}

SUREFOOT_ONCE bool leaves_only_noise(const EvaluatedHypothesis& one, const SearchProblem& problem) {
  const Eigen::VectorXd left = pooled(one.errors);
  for (Eigen::Index k = 0; k < left.size(); ++k) {
    const double noise = k < problem.noise.size() ? problem.noise[k] : 0;
    if (!(left[k] <= (1 + problem.criteria.tolerated_form) * noise)) return false;
  }
  return true;
}

SUREFOOT_ONCE double cost_of_own_numbers(const ErrorSquares& errors) {
  double cost = 0;
  for (Eigen::Index r = 0; r < errors.counts.rows(); ++r) {
    double independent = 0;
    for (Eigen::Index k = 0; k < errors.counts.cols(); ++k) independent += errors.counts(r, k) / errors.memory[k];
    cost += 0.5 * std::log(std::max(1.0, independent));
  }
  return cost;
}

SUREFOOT_ONCE EvaluatedHypothesis evaluate_fit(const BoundSimulator& bound, const Fit& fitted,
                                               const SearchProblem& problem, const Parallel& parallel) {
  EvaluatedHypothesis result{
      fitted.hypothesis, fitted.loss,
      error_squares(bound, fitted.hypothesis, problem.fit.recordings, problem.fit.integration, problem.scale, parallel),
      log_prior(bound, fitted.hypothesis, problem.known, problem.candidates, problem.criteria) +
          log_occam_factor(bound, fitted.hypothesis, problem.fit, least_variance(problem), parallel)};
  result.errors.least = problem.least;
  result.errors.least_elsewhere = negligible_beside(result.errors, problem);
  for (const AttachedEffect& one : fitted.hypothesis.effects) {
    if (one.effect->starts_anywhere) result.log_prior -= cost_of_own_numbers(result.errors);
  }
  return result;
}

/// Whether a variable is a strength of an effect that has another one before it.
SUREFOOT_ONCE bool is_spare_strength(const Hypothesis& hypothesis, const Variable& variable) {
  const auto& parameters = hypothesis.effects[variable.index].effect->parameters;
  const auto own = parameters.begin() + static_cast<std::ptrdiff_t>(variable.item);
  bool another = false;
  for (auto one = parameters.begin(); one != own; ++one) another = another || one->strength;
  return own->strength && another;
}

/// Where in its range a variable is, from 0 to 1.
SUREFOOT_ONCE double share_of_range(Hypothesis hypothesis, const Variable& variable) {
  const double low = to_search(variable, variable.low), high = to_search(variable, variable.high);
  return (to_search(variable, value_of(hypothesis, variable)) - low) / (high - low);
}

SUREFOOT_ONCE bool is_at_bound(const Hypothesis& hypothesis, const Variable& variable,
                               const SelectionCriteria& criteria) {
  constexpr double middle = 0.5;  // of a range
  const double share = share_of_range(hypothesis, variable);
  // a strength near zero is told by the densities, unless it still says how its input began
  const bool says_how_it_began =
      variable.kind == Variable::Kind::effect && hypothesis.effects[variable.index].effect->from_rest;
  const bool natural = variable.low == 0 && share < middle && !says_how_it_began;
  return !natural && (share < criteria.bound_share || share > 1 - criteria.bound_share);
}

SUREFOOT_ONCE double log_prior(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t known,
                               std::size_t candidates, const SelectionCriteria& criteria) {
  constexpr double nothing = 1e-3;  // of a range
  double sum = 0;
  for (std::size_t e = known; e < hypothesis.effects.size(); ++e) {
    const Effect& effect = *hypothesis.effects[e].effect;
    const std::size_t length = effect.parameters.size() + (effect.hidden_states > 0 ? 1 : 0);
    sum -= std::log(static_cast<double>(std::max<std::size_t>(1, candidates)));
    sum -= criteria.form_cost * static_cast<double>(length);
  }
  for (const Variable& variable : variables_of(bound, hypothesis, {})) {
    if (variable.kind != Variable::Kind::effect || variable.index < known) continue;
    const double share = share_of_range(hypothesis, variable);
    const bool idle = is_spare_strength(hypothesis, variable) && share < nothing;  // a simpler effect does as well
    if (idle) sum -= criteria.bound_cost;
    if (is_at_bound(hypothesis, variable, criteria)) sum -= criteria.bound_cost;
  }
  return sum;
}

SUREFOOT_ONCE Eigen::VectorXd negligible_differences(const ErrorSquares& without_effects,
                                                     const SelectionCriteria& criteria) {
  Eigen::VectorXd least = pooled(without_effects);
  for (double& value : least) {
    value *= criteria.form_error * criteria.form_error;
  }
  return least;
}

/// `value` nearer to zero by `margin`.
SUREFOOT_ONCE double shrunk(double value, double margin) {
  return value > margin ? value - margin : value < -margin ? value + margin : 0;
}

/// Log density of n errors with a mean square, in units of the square of their scale, that scale being known to some
/// degrees of freedom: Student's t; but for a constant.
SUREFOOT_ONCE double log_density(double n, double mean_square, double degrees) {
  return -0.5 * (n + degrees) * std::log1p(n * mean_square / degrees);
}

/// Differences of the mean square of output k to a reference that mean nothing.
SUREFOOT_ONCE double negligible_of(const ErrorSquares& reference, Eigen::Index k, Beside beside) {
  const double least = reference.least.size() > 0 ? reference.least[k] : 0;
  const double elsewhere = reference.least_elsewhere.size() > 0 ? reference.least_elsewhere[k] : least;
  if (beside == Beside::mended_form || !(elsewhere < least)) return least;
  return beside == Beside::as_many ? 0 : elsewhere;
}

SUREFOOT_ONCE std::vector<double> log_densities(const ErrorSquares& errors, const ErrorSquares& reference,
                                                const SelectionCriteria& criteria, Beside beside) {
  const Eigen::VectorXd scale = pooled(reference);
  std::vector<double> result(static_cast<std::size_t>(errors.counts.rows()), 0.0);
  for (Eigen::Index r = 0; r < errors.counts.rows(); ++r) {
    for (Eigen::Index k = 0; k < errors.counts.cols(); ++k) {
      const double cells = errors.counts(r, k);
      if (!(cells > 0)) continue;
      const double unit = std::max(scale[k], criteria.least_error * criteria.least_error);
      const double margin = negligible_of(reference, k, beside);
      const double best = reference.mean_squares(r, k), own = errors.mean_squares(r, k);
      const double beyond_form = best + shrunk(own - best, margin);
      result[static_cast<std::size_t>(r)] +=
          log_density(std::max(1.0, cells / reference.memory[k]), beyond_form / unit, criteria.degrees) +
          log_density(1, own / unit, criteria.degrees);  // an error of form lasts for all of a recording
    }
  }
  return result;
}

/// An effect with its place.
SUREFOOT_ONCE std::string label_at(const AttachedEffect& effect) {
  return effect.label() + "/" + std::to_string(static_cast<int>(effect.effect->place));
}

SUREFOOT_ONCE std::vector<std::string> structure_of(const Hypothesis& hypothesis) {
  std::vector<std::string> labels;
  for (const AttachedEffect& effect : hypothesis.effects) {
    labels.push_back(label_at(effect));
    for (std::size_t i = labels.size() - 1; i > 0 && labels[i] < labels[i - 1]; --i)
      std::swap(labels[i], labels[i - 1]);
  }
  return labels;
}

SUREFOOT_ONCE bool may_be_confused(const Effect& a, const Effect& b) {
  const auto says = [](const Effect& one, const std::string& name) {
    return std::find(one.confusable_with.begin(), one.confusable_with.end(), name) != one.confusable_with.end();
  };
  return says(a, b.name) || says(b, a.name);
}

SUREFOOT_ONCE bool is_like(const Effect& a, const Effect& b) { return a.name == b.name || may_be_confused(a, b); }

/// Whether an effect may make up for the form of another one that the machine has otherwise. What readings themselves
/// show, as that they come in steps, does not.
SUREFOOT_ONCE bool may_mend_form_of(const AttachedEffect& one, const AttachedEffect& other) {
  const Effect &a = *one.effect, &b = *other.effect;
  const auto forces = [](const Effect& effect) { return effect.place == Place::velocity || effect.needs_coupling; };
  const bool on_same = a.place == b.place && one.at == other.at;
  const bool along_coupling = (a.needs_coupling || b.needs_coupling) && forces(a) && forces(b);
  return !b.is_constant && !a.rounds && (on_same || along_coupling || is_like(a, b));
}

SUREFOOT_ONCE bool may_mend_form(const Hypothesis& larger, const Hypothesis& smaller) {
  const std::vector<std::string> known = structure_of(smaller);
  for (const AttachedEffect& extra : larger.effects) {
    if (std::find(known.begin(), known.end(), label_at(extra)) != known.end()) continue;
    const bool mends =
        holds_for_any(smaller.effects, [&](const AttachedEffect& one) { return may_mend_form_of(extra, one); });
    if (!mends) return false;
  }
  return true;
}

SUREFOOT_ONCE std::vector<double> log_densities_beside(const EvaluatedHypothesis& one,
                                                       const EvaluatedHypothesis& reference,
                                                       const SelectionCriteria& criteria) {
  Beside beside = Beside::as_many;
  if (one.hypothesis.effects.size() < reference.hypothesis.effects.size()) {
    beside = may_mend_form(reference.hypothesis, one.hypothesis) ? Beside::mended_form : Beside::more_elsewhere;
  }
  return log_densities(one.errors, reference.errors, criteria, beside);
}

/// The one that leaves least, beside which all others are weighed.
SUREFOOT_ONCE const EvaluatedHypothesis& closest(const std::vector<EvaluatedHypothesis>& evaluated) {
  return *std::min_element(evaluated.begin(), evaluated.end(),
                           [](const auto& a, const auto& b) { return a.errors.rms() < b.errors.rms(); });
}

SUREFOOT_ONCE std::size_t best_of(const std::vector<EvaluatedHypothesis>& evaluated,
                                  const SelectionCriteria& criteria) {
  if (evaluated.empty()) return 0;
  const EvaluatedHypothesis& reference = closest(evaluated);
  std::size_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    const std::vector<double> densities = log_densities_beside(evaluated[i], reference, criteria);
    double score = evaluated[i].log_prior;
    for (const double density : densities) score += density;
    if (!(score > most)) continue;
    most = score;
    best = i;
  }
  return best;
}

SUREFOOT_ONCE double log_odds(const EvaluatedHypothesis& a, const EvaluatedHypothesis& b,
                              const SelectionCriteria& criteria) {
  const EvaluatedHypothesis& reference = a.errors.rms() < b.errors.rms() ? a : b;
  const auto of_a = log_densities_beside(a, reference, criteria), of_b = log_densities_beside(b, reference, criteria);
  double sum = a.log_prior - b.log_prior;
  for (std::size_t r = 0; r < of_a.size(); ++r) sum += of_a[r] - of_b[r];
  return sum;
}

SUREFOOT_ONCE void forget_errors_of_form(ErrorSquares& errors) {
  errors.least.resize(0);
  errors.least_elsewhere.resize(0);
}

SUREFOOT_ONCE double log_odds_of_forms(EvaluatedHypothesis a, EvaluatedHypothesis b,
                                       const SelectionCriteria& criteria) {
  forget_errors_of_form(a.errors);
  forget_errors_of_form(b.errors);
  return log_odds(a, b, criteria);
}

SUREFOOT_ONCE std::vector<double> probabilities(const std::vector<EvaluatedHypothesis>& evaluated,
                                                const SelectionCriteria& criteria) {
  std::vector<double> result(evaluated.size(), 0.0);
  if (evaluated.empty()) return result;
  const EvaluatedHypothesis& reference = closest(evaluated);
  std::vector<std::vector<double>> densities;
  for (const EvaluatedHypothesis& one : evaluated) {
    densities.push_back(log_densities_beside(one, reference, criteria));
  }
  const std::size_t recordings = densities.front().size();
  Rng rng(criteria.seed, 0xb4a9u);
  std::vector<double> weight(recordings), score(evaluated.size());
  for (std::uint32_t round = 0; round < criteria.rounds; ++round) {
    double sum = 0;
    for (double& one : weight) sum += one = -std::log(1 - rng.uniform());  // Dirichlet(1, ..., 1)
    for (std::size_t h = 0; h < evaluated.size(); ++h) {
      score[h] = evaluated[h].log_prior;
      for (std::size_t r = 0; r < recordings; ++r) {
        score[h] += weight[r] / sum * static_cast<double>(recordings) * densities[h][r];
      }
    }
    const double most = *std::max_element(score.begin(), score.end());
    double total = 0;
    for (double& one : score) total += one = std::exp(one - most);
    for (std::size_t h = 0; h < evaluated.size(); ++h) result[h] += score[h] / total / criteria.rounds;
  }
  return result;
}

SUREFOOT_ONCE bool same_structure(const Hypothesis& a, const Hypothesis& b) {
  return structure_of(a) == structure_of(b);
}

SUREFOOT_ONCE bool same_effects(const Hypothesis& a, const Hypothesis& b) {
  const auto as_often_in_both = [&](const AttachedEffect& one) {
    const auto is_same = [&](const AttachedEffect& other) { return same_effect(one, other); };
    return count_items(a.effects, is_same) == count_items(b.effects, is_same);
  };
  return a.effects.size() == b.effects.size() && holds_for_all(a.effects, as_often_in_both);
}

SUREFOOT_ONCE bool is_among(const Hypothesis& one, const std::vector<Hypothesis>& others) {
  return holds_for_any(others, [&](const Hypothesis& other) { return same_effects(one, other); });
}

SUREFOOT_ONCE bool is_part_of(const Hypothesis& part, const Hypothesis& whole) {
  const std::vector<std::string> some = structure_of(part), all = structure_of(whole);
  return some.size() < all.size() && std::includes(all.begin(), all.end(), some.begin(), some.end());
}

SUREFOOT_ONCE bool holds_idle_effect(const EvaluatedHypothesis& one, const std::vector<EvaluatedHypothesis>& pool) {
  const double error = one.errors.rms();
  for (const EvaluatedHypothesis& other : pool) {
    const double without = other.errors.rms();
    if (!(error * error > clearly_less * without * without)) continue;
    if (is_part_of(other.hypothesis, one.hypothesis)) return true;
  }
  return false;
}

}  // namespace surefoot::diagnosis
