// Definitions of surefoot/diagnose/selection/search.hpp.
#pragma once

#include <Eigen/Core>
#include <cstdio>
#include <cstdlib>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/recording_error.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/pairs.hpp"
#include "surefoot/diagnose/selection/propose.hpp"
#include "surefoot/diagnose/selection/search.hpp"

#include <ctime>
#define DBGT(name) if (getenv("DBG")) fprintf(stderr, "  t %.1f %s\n", (double)clock()/CLOCKS_PER_SEC, name);
namespace surefoot::diagnosis {

SUREFOOT_INLINE Fit fit_child(const BoundSimulator& bound, const Hypothesis& parent,
                              const std::vector<Proposal>& additions, const SearchProblem& problem) {
  const SearchEffort& effort = problem.effort;
  FitProblem quick = problem.fit;
  quick.recordings = problem.screened;
  quick.max_iterations = effort.first_iterations;
  Fit best;
  const FitFunctions without(bound, parent, quick, serially());
  const double parent_loss = mean_loss(without.residuals(without.start()), quick.weighting.robust);
  const auto attempt = [&](const std::vector<Eigen::VectorXd>& starts, bool settle = false) {
    Hypothesis child = parent;
    for (std::size_t k = 0; k < starts.size(); ++k) {
      child.effects.push_back(additions[k].effect);
      child.values.push_back(starts[k]);
    }
    if (settle) {
      FitProblem around = quick;
      around.free = Free::all_but_effects;
      child = fit(bound, child, around, serially()).hypothesis;
    }
    const Fit one = fit(bound, child, quick, serially());
    if (one.ok && one.loss < best.loss) best = one;
  };
  std::vector<Eigen::VectorXd> predicted, weak;
  for (const Proposal& addition : additions) {
    predicted.push_back(addition.start);
    weak.push_back(addition.start);
    for (const Eigen::Index k : strengths_of(*addition.effect.effect)) weak.back()[k] *= effort.weak_start;
  }
  const bool scalable = predicted != weak;
  attempt(predicted, !scalable);  // what cannot grow from nothing begins with everything else settled around it
  if (scalable && !(best.loss < effort.bold_loss * parent_loss)) attempt(weak);
  if (!scalable && additions.size() == 1) {
    const auto& others = additions.front().more_starts;
    for (std::size_t k = 0; k < std::min(effort.more_starts, others.size()); ++k) attempt({others[k]}, true);
  }
  return best;
}

SUREFOOT_INLINE std::vector<Fit> fit_children(const BoundSimulator& bound, const Hypothesis& parent,
                                              const std::vector<std::vector<Proposal>>& additions,
                                              const SearchProblem& problem, std::size_t keep,
                                              const Parallel& parallel) {
  constexpr std::uint64_t scatter_seed = 1;
  const auto by_loss = [](const Fit& a, const Fit& b) { return a.loss < b.loss; };
  std::vector<Fit> fits(additions.size());
  parallel(additions.size(), [&](std::size_t i) {
    if (!problem.stopped()) fits[i] = fit_child(bound, parent, additions[i], problem);
  });
  if (getenv("DBG2")) for (auto& f : fits) { fprintf(stderr,"   quick %d loss %.4g ",(int)f.ok,f.loss); if(f.ok) for (size_t i=0;i<f.hypothesis.effects.size();++i){ fprintf(stderr," %s[",f.hypothesis.effects[i].label().c_str()); for(double v: f.hypothesis.values[i]) fprintf(stderr,"%.4g ",v); fprintf(stderr,"]");} fprintf(stderr," | "); for(double v: f.hypothesis.parameters) fprintf(stderr,"%.4g ",v); fprintf(stderr,"\n"); }
  DBGT("quick done")
  std::erase_if(fits, [](const Fit& one) { return !one.ok; });
  sort_items(fits, by_loss);
  if (fits.size() > keep) fits.resize(keep);
  parallel(fits.size(), [&](std::size_t i) {
    if (problem.stopped()) return;
    fits[i] = fit(bound, fits[i].hypothesis, problem.fit, serially());
    // what is missing may have pushed the calibrated parameters where no fit finds back from
    if (problem.scatter && parent.effects.size() == problem.known) {
      fits[i] = scattered_fit(bound, fits[i], fits[i].hypothesis, problem.fit, problem.effort.scattered_points,
                              scatter_seed, serially());
    }
  });
  sort_items(fits, by_loss);
  if (getenv("DBG2")) for (auto& f : fits) { fprintf(stderr,"   full %d loss %.4g ",(int)f.ok,f.loss); if(f.ok) for (size_t i=0;i<f.hypothesis.effects.size();++i){ fprintf(stderr," %s[",f.hypothesis.effects[i].label().c_str()); for(double v: f.hypothesis.values[i]) fprintf(stderr,"%.4g ",v); fprintf(stderr,"]");} fprintf(stderr," | "); for(double v: f.hypothesis.parameters) fprintf(stderr,"%.4g ",v); fprintf(stderr,"\n"); }
  return fits;
}

/// Effects that a parent has not yet, best first.
SUREFOOT_INLINE std::vector<Proposal> proposals_for(const Search& search, const EvaluatedHypothesis& parent) {
  const auto& [bound, problem, candidates, parallel] = search;
  FitProblem screened = problem.fit;
  screened.recordings = problem.screened;
  std::vector<AttachedEffect> open;
  for (const AttachedEffect& candidate : candidates) {
    const bool used = std::ranges::any_of(parent.hypothesis.effects, [&](const AttachedEffect& effect) {
      return effect.effect->name == candidate.effect->name && effect.at == candidate.at;
    });
    if (!used) open.push_back(candidate);
  }
  std::vector<Proposal> proposals = propose(bound, parent.hypothesis, screened, open, parallel);
  std::erase_if(proposals, [&](const Proposal& one) { return one.distinct < problem.criteria.least_distinct; });
  return proposals;
}

SUREFOOT_INLINE Hypothesis without_effect(const Hypothesis& whole, std::size_t effect) {
  Hypothesis rest = whole;
  rest.effects.erase(rest.effects.begin() + static_cast<std::ptrdiff_t>(effect));
  rest.values.erase(rest.values.begin() + static_cast<std::ptrdiff_t>(effect));
  return rest;
}

/// Fits parent plus proposals, and evaluates the best of them.
SUREFOOT_INLINE std::vector<EvaluatedHypothesis> evaluate_children(const Search& search,
                                                                   const EvaluatedHypothesis& parent,
                                                                   const std::vector<std::vector<Proposal>>& additions,
                                                                   std::size_t keep) {
  const auto& [bound, problem, candidates, parallel] = search;
  const std::vector<Fit> fits = fit_children(bound, parent.hypothesis, additions, problem, keep, parallel);
  std::vector<EvaluatedHypothesis> evaluated(fits.size());

  parallel(fits.size(), [&](std::size_t i) {
    if (!problem.stopped()) evaluated[i] = evaluate_fit(bound, fits[i], problem, serially());
  });
  DBGT("evaluated")
  std::erase_if(evaluated, [](const EvaluatedHypothesis& one) { return one.errors.empty(); });
  return evaluated;
}

/// The parent with one effect more. A signature that does not help as it is may do so once everything is fitted: such
/// proposals fill what room is left.
SUREFOOT_INLINE std::vector<EvaluatedHypothesis> next_effects(const Search& search, const EvaluatedHypothesis& parent,
                                                              std::vector<Proposal> proposals, std::size_t shortlist,
                                                              std::size_t finalists) {
  if (proposals.size() > shortlist) proposals.resize(shortlist);
  std::vector<std::vector<Proposal>> singles;
  for (Proposal& one : proposals) {
    if (!(one.gain > 0)) one.start = one.tried;
    singles.push_back({std::move(one)});
  }
  return evaluate_children(search, parent, singles, finalists);
}

/// The parent with two effects more.
SUREFOOT_INLINE std::vector<EvaluatedHypothesis> next_pairs(const Search& search, const EvaluatedHypothesis& parent,
                                                            const std::vector<Proposal>& proposals) {
  const SearchEffort& effort = search.problem.effort;
  std::vector<std::vector<Proposal>> pairs;
  for (ProposedPair& pair : propose_pairs(proposals, effort.pairs)) {
    pairs.push_back({std::move(pair.first), std::move(pair.second)});
  }
  return evaluate_children(search, parent, pairs, effort.pair_finalists);
}

SUREFOOT_INLINE EvaluatedHypothesis Search::without(const EvaluatedHypothesis& whole, std::size_t effect) const {
  const Fit rest = fit(bound, without_effect(whole.hypothesis, effect), problem.fit, parallel);
  return evaluate_fit(bound, rest, problem, parallel);
}

SUREFOOT_INLINE bool keep_best_form(std::vector<EvaluatedHypothesis>& pool, const EvaluatedHypothesis& one,
                                    const SelectionCriteria& criteria) {
  for (EvaluatedHypothesis& other : pool) {
    if (!same_structure(other.hypothesis, one.hypothesis)) continue;
    const bool better = log_odds(one, other, criteria) > 0;
    if (better) other = one;
    return better;
  }
  pool.push_back(one);
  return true;
}

SUREFOOT_INLINE std::vector<EvaluatedHypothesis> best_structures(std::vector<EvaluatedHypothesis> pool,
                                                                 std::size_t count, double hopeless,
                                                                 const SelectionCriteria& criteria) {
  std::vector<EvaluatedHypothesis> best;
  while (best.size() < count && !pool.empty()) {
    const std::size_t next = best_of(pool, criteria);
    if (!best.empty() && log_odds(pool[next], best.front(), criteria) < -hopeless) break;
    best.push_back(pool[next]);
    pool.erase(pool.begin() + static_cast<std::ptrdiff_t>(next));
  }
  return best;
}

SUREFOOT_INLINE void reweight(Search& search, const EvaluatedHypothesis& best) {
  FitProblem& problem = search.problem.fit;
  const auto runs =
      simulate_all(search.bound, best.hypothesis, problem.recordings, problem.integration, search.parallel);
  const Eigen::VectorXd sizes = residual_sizes(search.bound, problem.recordings, runs);
  for (Eigen::Index k = 0; k < sizes.size(); ++k) {
    const double least = search.problem.criteria.least_error * search.problem.scale.sigma[k];
    problem.weighting.sigma[k] = std::max(sizes[k], least);
  }
  problem.weighting.scale = recording_scales(search.bound, problem, runs);
  search.problem.screened = some_by_error(search.bound, problem.recordings, runs, search.problem.screened.size());
}

/// The children of one parent into the pool of children.
SUREFOOT_INLINE void extend(const Search& search, const EvaluatedHypothesis& parent,
                            std::vector<EvaluatedHypothesis>& children) {
  const SearchProblem& problem = search.problem;
  const auto most = static_cast<std::size_t>(problem.criteria.max_effects);
  const bool structured = problem.structured(parent.hypothesis);
  std::vector<Proposal> proposals = proposals_for(search, parent);
  if (!structured) {
    std::erase_if(proposals,
                  [&](const Proposal& one) { return one.gain < problem.criteria.unstructured_proposal_gain; });
  }
  bool any_better = false;
  for (const EvaluatedHypothesis& child :
       next_effects(search, parent, proposals, problem.effort.shortlist, problem.effort.finalists)) {
    any_better = any_better || log_odds(child, parent, problem.criteria) > 0;
    keep_best_form(children, child, problem.criteria);
  }
  const bool room = search.effects(parent) + 2 <= most, first = search.effects(parent) == 0;
  if (!structured || !room || (any_better && !first) || problem.stopped()) return;
  for (const EvaluatedHypothesis& child : next_pairs(search, parent, proposals)) {
    keep_best_form(children, child, problem.criteria);
  }
}

SUREFOOT_INLINE std::vector<EvaluatedHypothesis> extended(const Search& search,
                                                          const std::vector<EvaluatedHypothesis>& beam) {
  std::vector<EvaluatedHypothesis> children;
  for (const EvaluatedHypothesis& parent : beam) {
    if (!search.problem.stopped()) extend(search, parent, children);
  }
  return children;
}

SUREFOOT_INLINE std::vector<EvaluatedHypothesis> extended_from_nominal(Search search) {
  std::vector<EvaluatedHypothesis> children;
  if (search.problem.stopped()) return children;
  const Fit start{search.problem.nominal, 0, true};
  const EvaluatedHypothesis nominal = evaluate_fit(search.bound, start, search.problem, search.parallel);
  reweight(search, nominal);
  search.problem.scatter = false;
  extend(search, nominal, children);
  return children;
}

SUREFOOT_INLINE void grow(Search& search, std::vector<EvaluatedHypothesis>& pool) {
  const SelectionCriteria& criteria = search.problem.criteria;
  std::vector<EvaluatedHypothesis> beam = pool;
  for (int depth = 0; depth < criteria.max_effects && !search.problem.stopped(); ++depth) {
    search.problem.on_progress("searching effect " + std::to_string(depth + 1),
                               static_cast<double>(depth) / criteria.max_effects);
    const EvaluatedHypothesis best = pool[best_of(pool, criteria)];
    const auto most = static_cast<std::size_t>(criteria.max_effects);
    std::erase_if(beam, [&](const EvaluatedHypothesis& one) { return search.effects(one) >= most; });
    std::vector<EvaluatedHypothesis> children = extended(search, beam);
    if (depth == 0) {
      for (const EvaluatedHypothesis& child : extended_from_nominal(search)) keep_best_form(children, child, criteria);
    }
    for (const EvaluatedHypothesis& child : children) keep_best_form(pool, child, criteria);
    const EvaluatedHypothesis now = pool[best_of(pool, criteria)];
    if (same_structure(now.hypothesis, best.hypothesis)) break;
    const SearchEffort& effort = search.problem.effort;
    beam = best_structures(children, effort.beam, effort.hopeless, criteria);
    reweight(search, now);
  }
}

SUREFOOT_INLINE std::vector<EvaluatedHypothesis> fitted_again(const Search& search,
                                                              const std::vector<EvaluatedHypothesis>& pool) {
  const SearchEffort& effort = search.problem.effort;
  std::vector<EvaluatedHypothesis> best =
      best_structures(pool, effort.finalists, effort.hopeless, search.problem.criteria);
  const bool has_none = std::ranges::any_of(best, [&](const auto& one) { return search.effects(one) == 0; });
  for (const EvaluatedHypothesis& one : pool) {
    if (!has_none && search.effects(one) == 0) best.push_back(one);
  }
  search.parallel(best.size(), [&](std::size_t i) {
    const Fit fitted = fit(search.bound, best[i].hypothesis, search.problem.fit, serially());
    best[i] = evaluate_fit(search.bound, fitted, search.problem, serially());
  });
  return best;
}

SUREFOOT_INLINE void refit_best(const Search& search, std::vector<EvaluatedHypothesis>& pool) {
  if (search.problem.stopped()) return;
  for (const EvaluatedHypothesis& one : fitted_again(search, pool)) keep_best_form(pool, one, search.problem.criteria);
}

SUREFOOT_INLINE void swap_effects(const Search& search, std::vector<EvaluatedHypothesis>& pool) {
  constexpr double progress = 0.8;  // of the search
  const SearchProblem& problem = search.problem;
  const EvaluatedHypothesis best = pool[best_of(pool, problem.criteria)];
  for (std::size_t e = problem.known; e < best.hypothesis.effects.size() && !problem.stopped(); ++e) {
    problem.on_progress("comparing alternatives", progress);
    const EvaluatedHypothesis rest = search.without(best, e);
    keep_best_form(pool, rest, problem.criteria);
    if (search.effects(best) == 1) continue;  // its rivals were evaluated when it was chosen
    for (const EvaluatedHypothesis& other :
         next_effects(search, rest, proposals_for(search, rest), problem.effort.compared_shortlist,
                      problem.effort.compared_finalists)) {
      keep_best_form(pool, other, problem.criteria);
    }
  }
}

SUREFOOT_INLINE Comparison gain_of(const ErrorSquares& before, const ErrorSquares& after, double log_odds) {
  Comparison result;
  const double a = before.rms(), b = after.rms();
  if (!(a > 0)) return result;
  result.gain = 1 - b / a;
  double squares = 0;
  for (Eigen::Index r = 0; r < before.counts.rows(); ++r) {
    double off = 0;
    for (Eigen::Index k = 0; k < before.counts.cols(); ++k) {
      off += before.counts(r, k) * (after.mean_squares(r, k) - b * b / (a * a) * before.mean_squares(r, k));
    }
    squares += off * off;
  }
  double cells = 0;
  for (const double count : before.counts.reshaped()) cells += count;
  result.stderr_ = std::sqrt(squares) / (cells * a * a) / (2 * std::max(b / a, 1e-6));
  result.t = result.stderr_ > 0 ? result.gain / result.stderr_ : 0;
  result.p_value = 1 / (1 + std::exp(std::clamp(log_odds, -700.0, 700.0)));
  return result;
}

SUREFOOT_INLINE Selection ranked(const Search& search, const std::vector<EvaluatedHypothesis>& pool) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const std::vector<double> share = probabilities(pool, criteria);
  if (getenv("DBG")) for (auto& e : pool) { fprintf(stderr,"%8.4f rms %.5g prior %.1f loss %.4g mem",share[&e-&pool[0]],e.errors.rms(),e.log_prior,e.loss); for (double m : e.errors.memory) fprintf(stderr," %.1f",m); fprintf(stderr," odds %.1f ",log_odds(e,pool[best_of(pool,criteria)],criteria)); for (size_t i=0;i<e.hypothesis.effects.size();++i){ fprintf(stderr," %s[",e.hypothesis.effects[i].label().c_str()); for(double v: e.hypothesis.values[i]) fprintf(stderr,"%.4g ",v); fprintf(stderr,"]");} fprintf(stderr," | "); for(double v: e.hypothesis.parameters) fprintf(stderr,"%.4g ",v); fprintf(stderr,"\n"); }
  std::vector<std::size_t> order(pool.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  sort_items(order, [&](std::size_t a, std::size_t b) { return share[a] > share[b]; });
  Selection selection;
  selection.candidates = search.problem.candidates;
  double without = 0;
  for (std::size_t i = 0; i < pool.size(); ++i) {
    if (search.effects(pool[i]) > 0) continue;
    selection.nominal = pool[i];
    without = share[i];
  }
  const bool named = share[order.front()] > criteria.named_odds * without;
  selection.chosen = named ? pool[order.front()] : selection.nominal;
  selection.probability = named ? share[order.front()] : without;
  for (const std::size_t i : order) {
    if (same_structure(pool[i].hypothesis, selection.chosen.hypothesis)) continue;
    selection.alternatives.push_back(pool[i]);
    selection.alternative_probabilities.push_back(share[i]);
  }
  return selection;
}

SUREFOOT_INLINE std::vector<std::size_t> informative(const BoundSimulator& bound, const Hypothesis& calibrated,
                                                     const SearchProblem& problem, const Parallel& parallel) {
  const auto& all = problem.fit.recordings;
  double rows = 0;
  for (const std::size_t r : all) rows += static_cast<double>(bound.recordings[r].rows());
  const double share = static_cast<double>(problem.effort.rows) / std::max(rows, 1.0);
  if (share >= 1) return all;
  const auto count = static_cast<std::size_t>(std::ceil(share * static_cast<double>(all.size())));
  const auto runs = simulate_all(bound, calibrated, all, problem.fit.integration, parallel);
  return some_by_error(bound, all, runs, std::max(std::min(problem.screened.size(), all.size()), count));
}

SUREFOOT_INLINE Selection select_effects(const BoundSimulator& bound, const Fit& calibrated, SearchProblem problem,
                                         const std::vector<AttachedEffect>& candidates, const Parallel& parallel) {
  problem.candidates = candidates.size();
  Search search{bound, std::move(problem), candidates, parallel};
  const SelectionCriteria& criteria = search.problem.criteria;
  const std::vector<std::size_t> all = search.problem.fit.recordings;
  search.problem.fit.recordings = informative(bound, calibrated.hypothesis, search.problem, parallel);
  std::vector<EvaluatedHypothesis> pool{evaluate_fit(bound, calibrated, search.problem, parallel)};
  search.problem.least = pool.front().errors.least = least_squares_compared(pool.front().errors, criteria);
  grow(search, pool);
  for (int round = 0; round < 2 && search.effects(pool[best_of(pool, criteria)]) > 0; ++round) {
    const Hypothesis best = pool[best_of(pool, criteria)].hypothesis;
    reweight(search, pool[best_of(pool, criteria)]);
    refit_best(search, pool);
    swap_effects(search, pool);
    if (same_structure(pool[best_of(pool, criteria)].hypothesis, best)) break;
  }
  if (search.problem.fit.recordings.size() < all.size()) {
    search.problem.fit.recordings = all;
    reweight(search, pool[best_of(pool, criteria)]);
    search.problem.least = least_squares_compared(evaluate_fit(bound, calibrated, search.problem, parallel).errors, criteria);
    pool = fitted_again(search, pool);
  }
  DBGT("rank")
  Selection selection = ranked(search, pool);
  for (std::size_t e = search.problem.known; e < selection.chosen.hypothesis.effects.size(); ++e) {
    const EvaluatedHypothesis rest =
        search.effects(selection.chosen) == 1 ? selection.nominal : search.without(selection.chosen, e);
    selection.evidence.push_back(
        gain_of(rest.errors, selection.chosen.errors, log_odds(selection.chosen, rest, criteria)));
  }
  selection.fit = search.problem.fit;
  return selection;
}

}  // namespace surefoot::diagnosis
