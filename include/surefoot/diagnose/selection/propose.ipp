// Definitions of surefoot/diagnose/selection/propose.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/estimation/starting_values.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"
#include "surefoot/diagnose/selection/propose.hpp"
#include "surefoot/optimize/householder.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

using surefoot::detail::product, surefoot::detail::transposed_product, surefoot::detail::sum_of_squares;

SUREFOOT_ONCE Eigen::VectorXd OpenResiduals::beyond_parameters(const Eigen::VectorXd& change) const {
  if (basis.cols() == 0) return change;
  const Eigen::VectorXd along = product(basis, transposed_product(basis, change));
  Eigen::VectorXd beyond = change;
  for (Eigen::Index i = 0; i < beyond.size(); ++i) beyond[i] -= along[i];
  return beyond;
}

SUREFOOT_ONCE OpenResiduals open_residuals(const BoundSimulator& bound, const Hypothesis& base,
                                           const FitProblem& problem, const Parallel& parallel) {
  const FitFunctions functions(bound, base, problem, parallel);
  const Eigen::VectorXd z = functions.start();
  const double limit = problem.weighting.robust;
  OpenResiduals result;
  result.residuals = functions.residuals(z);
  if (z.size() > 0) result.basis = surefoot::detail::orthonormal_basis(functions.jacobian(z, result.residuals));
  Eigen::VectorXd clipped = result.residuals;
  for (double& value : clipped) value = std::isfinite(value) ? std::clamp(value, -limit, limit) : 0.0;
  result.open = result.beyond_parameters(clipped);
  result.energy = std::max(sum_of_squares(result.open), never_zero);
  return result;
}

SUREFOOT_ONCE std::vector<Eigen::Index> strengths_of(const Effect& effect) {
  std::vector<Eigen::Index> strengths;
  for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
    if (effect.parameters[k].strength) strengths.push_back(static_cast<Eigen::Index>(k));
  }
  return strengths;
}

SUREFOOT_ONCE Hypothesis with_effect(Hypothesis base, const AttachedEffect& effect, const Eigen::VectorXd& values,
                                     std::size_t before) {
  insert_item(base.effects, before, effect);
  insert_item(base.values, before, values_before_starts(*effect.effect, values, base.initial.size()));
  return base;
}

SUREFOOT_ONCE Eigen::MatrixXd signatures(const BoundSimulator& bound, const Hypothesis& base, const FitProblem& problem,
                                         const Eigen::VectorXd& residuals, const AttachedEffect& candidate,
                                         const Eigen::VectorXd& start, std::size_t before) {
  const std::vector<Eigen::Index> strengths = strengths_of(*candidate.effect);
  const auto count = static_cast<Eigen::Index>(std::max<std::size_t>(1, strengths.size()));
  Eigen::MatrixXd result(residuals.size(), count);
  for (Eigen::Index m = 0; m < count; ++m) {
    Eigen::VectorXd values = start;
    for (const Eigen::Index k : strengths) {
      if (k != strengths[static_cast<std::size_t>(m)]) values[k] = 0;
    }
    const Hypothesis with = with_effect(base, candidate, values, before);
    const FitFunctions changed(bound, with, problem, serially());
    const Eigen::VectorXd after = changed.residuals(changed.start());
    if (!surefoot::all_finite(after)) return {};
    for (Eigen::Index i = 0; i < residuals.size(); ++i) result(i, m) = after[i] - residuals[i];
  }
  return result;
}

SUREFOOT_ONCE Eigen::VectorXd as_large_as_residuals(const AttachedEffect& candidate, const Eigen::VectorXd& values,
                                                    const Eigen::MatrixXd& signatures, const OpenResiduals& open,
                                                    const ProposalCriteria& criteria) {
  Eigen::VectorXd result = values;
  if (candidate.effect->is_impulsive) return result;
  const double residuals = sum_of_squares(open.residuals);
  const std::vector<Eigen::Index> strengths = strengths_of(*candidate.effect);
  for (std::size_t m = 0; m < strengths.size(); ++m) {
    const double squares = sum_of_squares(surefoot::detail::column_of(signatures, static_cast<Eigen::Index>(m)));
    const double ratio = std::sqrt(residuals / std::max(squares, never_zero));
    if (ratio < criteria.resized_from) result[strengths[m]] *= ratio;
  }
  return result;
}

/// Limits of the multiples of the signatures: those of the strengths; 0 to 1 where there is none.
SUREFOOT_ONCE std::pair<Eigen::VectorXd, Eigen::VectorXd> limits_of_shares(const BoundSimulator& bound,
                                                                           const AttachedEffect& candidate,
                                                                           const Eigen::VectorXd& start,
                                                                           Eigen::Index count) {
  Eigen::VectorXd least = Eigen::VectorXd::Zero(count), most = Eigen::VectorXd::Ones(count);
  const std::vector<Eigen::Index> strengths = strengths_of(*candidate.effect);
  for (std::size_t m = 0; m < strengths.size(); ++m) {
    const Eigen::Index k = strengths[m];
    const EffectParameter& parameter = candidate.effect->parameters[static_cast<std::size_t>(k)];
    const double unit = measure_size(bound, candidate, parameter.measure);
    const double a = parameter.low * unit / start[k], b = parameter.high * unit / start[k];
    const auto at = static_cast<Eigen::Index>(m);
    least[at] = candidate.effect->is_impulsive ? 1 : std::min(a, b);
    most[at] = candidate.effect->is_impulsive ? 1 : std::max(a, b);
  }
  return {least, most};
}

SUREFOOT_ONCE Proposal predict_gain(const BoundSimulator& bound, const OpenResiduals& open,
                                    const AttachedEffect& candidate, const Eigen::VectorXd& start,
                                    const Eigen::MatrixXd& signatures, const ProposalCriteria& criteria) {
  Proposal proposal;
  if (signatures.cols() == 0) return proposal;
  proposal.effect = candidate;
  proposal.start = start;
  proposal.tried = start;
  const Eigen::Index count = signatures.cols();
  Eigen::MatrixXd distinct(signatures.rows(), count);
  double all = 0;
  for (Eigen::Index m = 0; m < count; ++m) {
    const Eigen::VectorXd signature = surefoot::detail::column_of(signatures, m);
    const Eigen::VectorXd beyond = open.beyond_parameters(signature);
    all += sum_of_squares(signature);
    for (Eigen::Index i = 0; i < beyond.size(); ++i) distinct(i, m) = beyond[i];
  }
  const double left = surefoot::detail::dot(distinct.data(), distinct.data(), distinct.size());
  proposal.distinct = all > 0 ? std::sqrt(left / all) : 0;
  if (!(left > criteria.negligible_signature * open.energy)) return proposal;
  proposal.visible = std::sqrt(criteria.visible_share * open.energy / left);
  Eigen::MatrixXd gram = transposed_product(distinct, distinct);
  for (Eigen::Index m = 0; m < count; ++m) gram(m, m) += criteria.ridge * left;
  Eigen::VectorXd against = transposed_product(distinct, open.open);
  for (double& value : against) value = -value;
  Eigen::VectorXd share = surefoot::detail::solve_symmetric(gram, against);
  auto limits = limits_of_shares(bound, candidate, start, count);
  proposal.least_share = std::move(limits.first);
  proposal.most_share = std::move(limits.second);
  const std::vector<Eigen::Index> strengths = strengths_of(*candidate.effect);
  for (Eigen::Index m = 0; m < count; ++m) {
    share[m] = std::clamp(share[m], proposal.least_share[m], proposal.most_share[m]);
    if (strengths.empty() || candidate.effect->is_impulsive) continue;
    const Eigen::Index k = strengths[static_cast<std::size_t>(m)];
    proposal.start[k] = share[m] * start[k];
  }
  Eigen::VectorXd rest = product(distinct, share);
  for (Eigen::Index i = 0; i < rest.size(); ++i) rest[i] += open.open[i];
  proposal.gain = 1 - sum_of_squares(rest) / open.energy;
  if (strengths.empty()) proposal.least_share.setOnes();  // beside others it begins as it was tried
  const double unit = 1 / std::sqrt(open.energy);
  for (Eigen::Index i = 0; i < distinct.size(); ++i) distinct.data()[i] *= unit;
  for (double& value : against) value *= -unit * unit;
  proposal.beyond = std::move(distinct);
  proposal.along = std::move(against);
  return proposal;
}

/// The best proposal of each effect, with its other starts in their order; behind the effects of the base, of which
/// there are `behind`, unless it clearly does more in front of them.
SUREFOOT_ONCE std::vector<Proposal> best_of_each_effect(std::vector<Proposal> tried, std::size_t behind,
                                                        const ProposalCriteria& criteria) {
  drop_items(tried, [](const Proposal& one) { return !one.effect.effect; });
  std::vector<Proposal> in_front;
  for (const Proposal& one : tried) {
    if (one.before < behind) in_front.push_back(one);
  }
  drop_items(tried, [&](const Proposal& one) { return one.before < behind; });
  for (Proposal& one : in_front) {
    const bool clearly = !holds_for_any(tried, [&](const Proposal& other) {
      return other.before == behind && same_effect(other.effect, one.effect) &&
             !(one.gain > other.gain + criteria.order_matters);
    });
    if (clearly) tried.push_back(std::move(one));
  }
  sort_items(tried, [](const Proposal& a, const Proposal& b) { return a.gain > b.gain; });
  std::vector<Proposal> best;
  for (const Proposal& one : tried) {
    const auto same = find_item(best, [&](const Proposal& other) { return same_effect(other.effect, one.effect); });
    if (same == nullptr) {
      best.push_back(one);
    } else if (same->before == one.before) {
      same->more_starts.push_back(one.start);
    }
  }
  return best;
}

/// The first of the effects from `known` on that act on the same input or output; their number if there is none.
SUREFOOT_ONCE std::size_t first_on_the_same(const Hypothesis& base, const AttachedEffect& candidate,
                                            std::size_t known) {
  const Place place = candidate.effect->place;
  if (place != Place::input && place != Place::output) return base.effects.size();
  std::size_t e = known;
  while (e < base.effects.size() && (base.effects[e].effect->place != place || base.effects[e].at != candidate.at)) ++e;
  return e;
}

/// What an output would have read, and what is simulated, without the effects of `base` on it from `before` on.
SUREFOOT_ONCE std::vector<Observed> observe_before(const BoundSimulator& bound, const Hypothesis& base,
                                                   const AttachedEffect& candidate, std::size_t before,
                                                   const FitProblem& problem, std::vector<Observed> observed) {
  Hypothesis first = base;
  for (std::size_t e = base.effects.size(); e-- > before;) {
    if (base.effects[e].effect->place != Place::output || base.effects[e].at != candidate.at) continue;
    first = without_effect(first, e);
  }
  const auto runs = simulate_all(bound, first, problem.recordings, problem.integration, serially());
  const std::vector<Observed> bare = observe(bound, problem.recordings, runs);
  for (std::size_t k = 0; k < observed.size(); ++k) {
    for (std::size_t i = 0; i < observed[k].readings.size(); ++i) {
      observed[k].readings[i] -= observed[k].simulated[i] - bare[k].simulated[i];
    }
    observed[k].simulated = bare[k].simulated;
  }
  return observed;
}

/// A candidate, where in the order of effects it acts, and what it begins with.
struct Trial {
  std::size_t candidate = 0, before = 0;
  Eigen::VectorXd start;
};

SUREFOOT_ONCE std::vector<Trial> trials_of(const BoundSimulator& bound, const Hypothesis& base,
                                           const FitProblem& problem, const std::vector<AttachedEffect>& candidates,
                                           std::size_t known, const Parallel& parallel) {
  const auto observed =
      observe(bound, problem.recordings, simulate_all(bound, base, problem.recordings, problem.integration, parallel));
  std::vector<std::vector<Trial>> by_candidate(candidates.size());
  parallel(candidates.size(), [&](std::size_t c) {
    const AttachedEffect& candidate = candidates[c];
    if (!candidate.effect->extends.empty()) return;
    const auto add = [&](std::size_t before, const std::vector<Observed>& seen) {
      for (const Eigen::VectorXd& start : starting_values(bound, candidate, seen)) {
        by_candidate[c].push_back({c, before, start});
      }
    };
    add(base.effects.size(), observed);
    const std::size_t first = first_on_the_same(base, candidate, known);
    if (first == base.effects.size()) return;
    const bool looks = candidate.effect->suggest && candidate.effect->place == Place::output;
    add(first, looks ? observe_before(bound, base, candidate, first, problem, observed) : observed);
  });
  std::vector<Trial> trials;
  for (std::vector<Trial>& some : by_candidate) {
    std::move(some.begin(), some.end(), std::back_inserter(trials));
  }
  return trials;
}

/// Where the trials of one candidate at one place in the order begin, and their end.
SUREFOOT_ONCE std::vector<std::size_t> groups_of(const std::vector<Trial>& trials) {
  std::vector<std::size_t> begin{0};
  for (std::size_t j = 1; j < trials.size(); ++j) {
    const bool same = trials[j].candidate == trials[j - 1].candidate && trials[j].before == trials[j - 1].before;
    if (!same) begin.push_back(j);
  }
  if (!trials.empty()) begin.push_back(trials.size());
  return begin;
}

/// Values as multiples of others; 1 where the other is zero.
SUREFOOT_ONCE Eigen::VectorXd ratios(const Eigen::VectorXd& values, const Eigen::VectorXd& of) {
  Eigen::VectorXd result = Eigen::VectorXd::Ones(values.size());
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (of[k] != 0) result[k] = values[k] / of[k];
  }
  return result;
}

SUREFOOT_ONCE std::vector<Proposal> propose(const BoundSimulator& bound, const Hypothesis& base,
                                            const FitProblem& problem, const std::vector<AttachedEffect>& candidates,
                                            std::size_t known, const Parallel& parallel,
                                            const ProposalCriteria& criteria) {
  const OpenResiduals open = open_residuals(bound, base, problem, parallel);
  const Hypothesis smooth = without_rounding(base);  // what is inside of a step would hide what an effect does
  const FitFunctions unrounded(bound, smooth, problem, parallel);
  const bool rounds = smooth.effects.size() < base.effects.size();
  const Eigen::VectorXd smooth_residuals = rounds ? unrounded.residuals(unrounded.start()) : open.residuals;
  const std::vector<Trial> trials = trials_of(bound, base, problem, candidates, known, parallel);
  std::vector<Proposal> tried(trials.size());
  const std::vector<std::size_t> begin = groups_of(trials);
  parallel(begin.size() - 1, [&](std::size_t group) {
    Eigen::VectorXd sizes;  // multiples of the strengths of a start, as the start before has found them
    for (std::size_t j = begin[group]; j < begin[group + 1]; ++j) {
      const auto& [c, before, start] = trials[j];
      const bool shares_its_place = first_on_the_same(base, candidates[c], known) < base.effects.size();
      const auto signatures_of = [&, c = c, before = before](const Eigen::VectorXd& values) {
        if (shares_its_place) return signatures(bound, base, problem, open.residuals, candidates[c], values, before);
        return signatures(bound, smooth, problem, smooth_residuals, candidates[c], values, smooth.effects.size());
      };
      Eigen::VectorXd values = start;
      for (Eigen::Index k = 0; k < sizes.size(); ++k) values[k] *= sizes[k];
      Eigen::MatrixXd changes = signatures_of(values);
      for (int round = 0; round < criteria.resizings && changes.cols() > 0; ++round) {
        const Eigen::VectorXd smaller = as_large_as_residuals(candidates[c], values, changes, open, criteria);
        if (std::equal(smaller.begin(), smaller.end(), values.begin())) break;
        values = smaller;
        changes = signatures_of(values);
      }
      tried[j] = predict_gain(bound, open, candidates[c], values, changes, criteria);
      tried[j].before = before;
      sizes = ratios(values, start);
    }
  });
  return best_of_each_effect(std::move(tried), base.effects.size(), criteria);
}

}  // namespace surefoot::diagnosis
