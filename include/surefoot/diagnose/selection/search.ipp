// Definitions of surefoot/diagnose/selection/search.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/propose.hpp"
#include "surefoot/diagnose/selection/search.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE Fit fit_child(const BoundSimulator& bound, const Hypothesis& parent,
                              const std::vector<Proposal>& additions, const SearchProblem& problem) {
  const SearchEffort& effort = problem.effort;
  FitProblem quick = problem.fit;
  quick.recordings = problem.screened;
  quick.max_iterations = effort.first_iterations;
  Fit best;
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
  if (scalable && !(best.loss < effort.bold_loss)) attempt(weak);
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
  std::erase_if(fits, [](const Fit& one) { return !one.ok; });
  sort_items(fits, by_loss);
  if (fits.size() > keep) fits.resize(keep);
  parallel(fits.size(), [&](std::size_t i) {
    if (problem.stopped()) return;
    fits[i] = fit(bound, fits[i].hypothesis, problem.fit, serially());
    // what is missing may have pushed the calibrated parameters where no fit finds back from
    if (parent.effects.size() == problem.known) {
      fits[i] = scattered_fit(bound, fits[i], fits[i].hypothesis, problem.fit, problem.effort.scattered_points,
                              scatter_seed, serially());
    }
  });
  sort_items(fits, by_loss);
  return fits;
}

SUREFOOT_INLINE std::vector<EvaluatedHypothesis> evaluate_all(const BoundSimulator& bound, const std::vector<Fit>& fits,
                                                              const EvaluatedHypothesis& parent,
                                                              const SearchProblem& problem, std::size_t keep,
                                                              const Parallel& parallel) {
  const SearchEffort& effort = problem.effort;
  const auto ties = [&](const Fit& one) { return one.loss < effort.near_tie * fits.front().loss + never_zero; };
  while (keep < fits.size() && ties(fits[keep]) && keep < effort.max_finalists) ++keep;
  std::vector<EvaluatedHypothesis> evaluated(std::min(keep, fits.size()));
  parallel(evaluated.size(), [&](std::size_t i) {
    if (problem.stopped()) return;
    evaluated[i] = evaluate_fit(bound, fits[i], problem, serially());
    evaluated[i].gain = compare_losses(parent.cross_validated, evaluated[i].cross_validated);
    // parameters that cannot be told from zero speak against what was added, and against what that leaves undetermined
    if (!determined(bound, fits[i].hypothesis, problem.known, problem.fit, serially(), problem.criteria)) {
      evaluated[i].cross_validated = {};
    }
  });
  std::erase_if(evaluated, [](const EvaluatedHypothesis& one) { return one.cross_validated.blocks.empty(); });
  return evaluated;
}

SUREFOOT_INLINE std::vector<Proposal> shortlisted(const BoundSimulator& bound, const Hypothesis& base,
                                                  const SearchProblem& problem,
                                                  const std::vector<AttachedEffect>& candidates, std::size_t count,
                                                  bool structured, const Parallel& parallel) {
  FitProblem screened = problem.fit;
  screened.recordings = problem.screened;
  std::vector<AttachedEffect> open;
  for (const AttachedEffect& candidate : candidates) {
    const bool used = std::any_of(base.effects.begin(), base.effects.end(), [&](const AttachedEffect& effect) {
      return effect.effect->name == candidate.effect->name && effect.at == candidate.at;
    });
    if (!used) open.push_back(candidate);
  }
  std::vector<Proposal> proposals = propose(bound, base, screened, open, parallel);
  // A signature that does not help as it is may do so once everything is fitted: such proposals fill what room is left.
  std::erase_if(proposals, [&](const Proposal& one) {
    return one.distinct < problem.criteria.least_distinct ||
           (!structured && one.gain < problem.criteria.unstructured_proposal_gain);
  });
  if (proposals.size() > count) proposals.resize(count);
  for (Proposal& one : proposals) {
    if (!(one.gain > 0)) one.start = one.tried;
  }
  return proposals;
}

SUREFOOT_INLINE Hypothesis without_effect(const Hypothesis& whole, std::size_t effect) {
  Hypothesis rest = whole;
  rest.effects.erase(rest.effects.begin() + static_cast<std::ptrdiff_t>(effect));
  rest.values.erase(rest.values.begin() + static_cast<std::ptrdiff_t>(effect));
  return rest;
}

SUREFOOT_INLINE std::vector<EvaluatedHypothesis> next_effects(const BoundSimulator& bound,
                                                              const EvaluatedHypothesis& parent,
                                                              const SearchProblem& problem,
                                                              const std::vector<AttachedEffect>& candidates,
                                                              bool structured, const Parallel& parallel) {
  const SearchEffort& effort = problem.effort;
  const std::vector<Proposal> proposals =
      shortlisted(bound, parent.hypothesis, problem, candidates, effort.shortlist, structured, parallel);
  std::vector<std::vector<Proposal>> singles;
  for (const Proposal& proposal : proposals) singles.push_back({proposal});
  const std::vector<Fit> fits =
      fit_children(bound, parent.hypothesis, singles, problem, effort.finalists + effort.reserve, parallel);
  return evaluate_all(bound, fits, parent, problem, effort.finalists, parallel);
}

SUREFOOT_INLINE std::vector<EvaluatedHypothesis> next_pairs(const BoundSimulator& bound,
                                                            const EvaluatedHypothesis& parent,
                                                            const SearchProblem& problem,
                                                            const std::vector<AttachedEffect>& candidates,
                                                            const Parallel& parallel) {
  const SearchEffort& effort = problem.effort;
  const std::vector<Proposal> proposals =
      shortlisted(bound, parent.hypothesis, problem, candidates, effort.paired, true, parallel);
  std::vector<std::vector<Proposal>> pairs;
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    for (std::size_t j = i + 1; j < proposals.size(); ++j) {
      if (proposals[i].effect.effect->name == proposals[j].effect.effect->name) continue;
      pairs.push_back({proposals[i], proposals[j]});
    }
  }
  const std::vector<Fit> fits = fit_children(bound, parent.hypothesis, pairs, problem, effort.pair_reserve, parallel);
  return evaluate_all(bound, fits, parent, problem, effort.pair_finalists, parallel);
}

SUREFOOT_INLINE EvaluatedHypothesis Search::without(const EvaluatedHypothesis& whole, std::size_t effect) const {
  const Fit rest = fit(bound, without_effect(whole.hypothesis, effect), problem.fit, parallel);
  return evaluate_fit(bound, rest, problem, parallel);
}

SUREFOOT_INLINE void drop_idle_effects(const Search& search, EvaluatedHypothesis& chosen) {
  std::size_t i = search.problem.known;
  while (search.effects(chosen) > 1 && i < chosen.hypothesis.effects.size() && !search.problem.stopped()) {
    const EvaluatedHypothesis less = search.without(chosen, i);
    const Comparison worth = compare_losses(less.cross_validated, chosen.cross_validated);
    if (idle(worth, search.problem.criteria)) {
      chosen = less;
    } else {
      ++i;
    }
  }
}

SUREFOOT_INLINE void add_effects(const Search& search, Selection& selection) {
  const auto& [bound, problem, candidates, parallel] = search;
  const SelectionCriteria& criteria = problem.criteria;
  const auto most = static_cast<std::size_t>(criteria.max_effects);
  while (search.effects(selection.chosen) < most && !problem.stopped()) {
    const std::size_t depth = search.effects(selection.chosen);
    problem.on_progress("searching effect " + std::to_string(depth + 1),
                        static_cast<double>(depth) / static_cast<double>(most));
    const bool structured = problem.structured(selection.chosen.hypothesis);
    std::vector<EvaluatedHypothesis> next =
        next_effects(bound, selection.chosen, problem, candidates, structured, parallel);
    const double share = search.share(selection.chosen, selection.nominal);
    std::optional<std::size_t> choice = most_plausible_accepted(next, search.tests(), share, criteria);
    if (!choice && structured && depth + 2 <= most && !problem.stopped()) {
      const std::vector<EvaluatedHypothesis> pairs = next_pairs(bound, selection.chosen, problem, candidates, parallel);
      choice = most_plausible_accepted(pairs, criteria.tests_per_pair * search.tests(), share, criteria);
      if (choice) next = pairs;
    }
    if (!choice) {
      if (depth == 0) selection.alternatives = next;  // what was refused
      return;
    }
    selection.chosen = next[*choice];
    next.erase(next.begin() + static_cast<std::ptrdiff_t>(*choice));
    selection.alternatives = next;
    drop_idle_effects(search, selection.chosen);
  }
}

SUREFOOT_INLINE void try_pair_instead(const Search& search, Selection& selection) {
  const auto& [bound, problem, candidates, parallel] = search;
  if (search.effects(selection.chosen) != 1 || problem.criteria.max_effects < 2 || problem.stopped()) return;
  if (!problem.structured(selection.chosen.hypothesis)) return;
  const std::vector<EvaluatedHypothesis> pairs = next_pairs(bound, selection.nominal, problem, candidates, parallel);
  if (pairs.empty()) return;
  const EvaluatedHypothesis& pair = pairs[most_plausible(pairs, problem.criteria)];
  const Comparison lead = compare_losses(selection.chosen.cross_validated, pair.cross_validated);
  if (accepted(lead, search.tests(), 1, problem.criteria)) selection.chosen = pair;
}

SUREFOOT_INLINE std::vector<EvaluatedHypothesis> rivals_of(const Search& search, const EvaluatedHypothesis& rest,
                                                           const AttachedEffect& effect) {
  SearchProblem fewer = search.problem;
  fewer.effort.shortlist = search.problem.effort.compared_shortlist;
  fewer.effort.finalists = search.problem.effort.compared_finalists;
  std::vector<EvaluatedHypothesis> rivals =
      next_effects(search.bound, rest, fewer, search.candidates, true, search.parallel);
  std::erase_if(rivals,
                [&](const EvaluatedHypothesis& other) { return same_effect(other.hypothesis.effects.back(), effect); });
  return rivals;
}

SUREFOOT_INLINE bool compare_with_others(const Search& search, Selection& selection, bool replace) {
  constexpr double progress = 0.8;  // of the search
  const SearchProblem& problem = search.problem;
  bool replaced = false;
  selection.evidence.clear();
  const bool alone = search.effects(selection.chosen) == 1;  // its rivals were evaluated when it was chosen
  if (!alone) selection.alternatives.clear();
  for (std::size_t i = problem.known; i < selection.chosen.hypothesis.effects.size() && !problem.stopped(); ++i) {
    problem.on_progress("comparing alternatives", progress);
    const EvaluatedHypothesis rest = alone ? selection.nominal : search.without(selection.chosen, i);
    if (!alone) {
      const double before = search.share(rest, selection.nominal);
      for (EvaluatedHypothesis& other : rivals_of(search, rest, selection.chosen.hypothesis.effects[i])) {
        const Comparison lead = compare_losses(selection.chosen.cross_validated, other.cross_validated);
        if (replace && replaces(lead, search.share(selection.chosen, selection.nominal), problem.criteria) &&
            accepted(other.gain, search.tests(), before, problem.criteria)) {
          std::swap(selection.chosen, other);
          replaced = true;
        }
        selection.alternatives.push_back(other);
      }
    }
    selection.evidence.push_back(compare_losses(rest.cross_validated, selection.chosen.cross_validated));
  }
  return replaced;
}

SUREFOOT_INLINE Selection select_effects(const BoundSimulator& bound, const Fit& calibrated,
                                         const SearchProblem& problem, const std::vector<AttachedEffect>& candidates,
                                         const Parallel& parallel) {
  const Search search{bound, problem, candidates, parallel};
  Selection selection;
  selection.candidates = candidates.size();
  selection.nominal = evaluate_fit(bound, calibrated, problem, parallel);
  selection.chosen = selection.nominal;
  add_effects(search, selection);
  try_pair_instead(search, selection);
  if (search.effects(selection.chosen) == 0) return selection;
  if (compare_with_others(search, selection, true)) {
    drop_idle_effects(search, selection.chosen);
    compare_with_others(search, selection, false);
  }
  return selection;
}

}  // namespace surefoot::diagnosis
