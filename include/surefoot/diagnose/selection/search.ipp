// Definitions of surefoot/diagnose/selection/search.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/propose.hpp"
#include "surefoot/diagnose/selection/search.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE std::vector<Fit> fit_children(const BoundSimulator& bound, const Hypothesis& parent,
                                              const std::vector<std::vector<Proposal>>& additions,
                                              const SearchProblem& problem, std::size_t keep,
                                              const Parallel& parallel) {
  std::vector<Fit> fits(additions.size());
  parallel(additions.size(), [&](std::size_t i) {
    if (problem.stopped()) return;
    FitProblem quick = problem.fit;
    quick.recordings = problem.screened;
    quick.max_iterations = 3;
    const auto attempt = [&](const std::vector<Eigen::VectorXd>& starts, bool settle = false) {
      Hypothesis child = parent;
      for (std::size_t k = 0; k < starts.size(); ++k) {
        child.effects.push_back(additions[i][k].effect);
        child.values.push_back(starts[k]);
      }
      if (settle) {
        FitProblem around = quick;
        around.free = Free::all_but_effects;
        child = fit(bound, child, around, serially()).hypothesis;
      }
      const Fit one = fit(bound, child, quick, serially());
      if (one.ok && one.loss < fits[i].loss) fits[i] = one;
    };
    std::vector<Eigen::VectorXd> best, weak;
    for (const Proposal& addition : additions[i]) {
      best.push_back(addition.start);
      weak.push_back(addition.start);
      for (std::size_t k = 0; k < addition.effect.effect->parameters.size(); ++k) {
        if (addition.effect.effect->parameters[k].strength) weak.back()[static_cast<Eigen::Index>(k)] *= 0.3;
      }
    }
    const bool scalable = best != weak;
    attempt(best, !scalable);  // what cannot grow from nothing begins with everything else settled around it
    if (scalable && !(fits[i].loss < 0.97)) attempt(weak);  // the linear guess may have been too bold
    if (!scalable && additions[i].size() == 1) {
      const auto& others = additions[i].front().more_starts;
      for (std::size_t k = 0; k < std::min<std::size_t>(2, others.size()); ++k) attempt({others[k]}, true);
    }
  });
  std::erase_if(fits, [](const Fit& one) { return !one.ok; });
  std::ranges::sort(fits, [](const Fit& a, const Fit& b) { return a.loss < b.loss; });
  if (fits.size() > keep) fits.resize(keep);
  parallel(fits.size(), [&](std::size_t i) {
    if (problem.stopped()) return;
    fits[i] = fit(bound, fits[i].hypothesis, problem.fit, serially());
    // what is missing may have pushed the calibrated parameters where no fit finds back from
    if (parent.effects.size() == problem.known) {
      fits[i] = scattered_fit(bound, fits[i], fits[i].hypothesis, problem.fit, 12, 1, serially());
    }
  });
  std::ranges::sort(fits, [](const Fit& a, const Fit& b) { return a.loss < b.loss; });
  return fits;
}

SUREFOOT_INLINE std::vector<EvaluatedHypothesis> evaluate_all(const BoundSimulator& bound, const std::vector<Fit>& fits,
                                                              const EvaluatedHypothesis& parent,
                                                              const SearchProblem& problem, std::size_t keep,
                                                              const Parallel& parallel) {
  while (keep < fits.size() && fits[keep].loss < 1.05 * fits.front().loss + 1e-300 && keep < 9) ++keep;  // near ties
  std::vector<EvaluatedHypothesis> judged(std::min(keep, fits.size()));
  parallel(judged.size(), [&](std::size_t i) {
    if (problem.stopped()) return;
    judged[i] = judge(bound, fits[i], problem, serially());
    judged[i].gain = compare_losses(parent.heldout, judged[i].heldout);
    // numbers that cannot be told from zero speak against what was added, and against what that leaves undetermined
    if (!determined(bound, fits[i].hypothesis, problem.known, problem.fit, serially())) judged[i].heldout = {};
  });
  std::erase_if(judged, [](const EvaluatedHypothesis& one) { return one.heldout.blocks.empty(); });
  return judged;
}

SUREFOOT_INLINE std::vector<Proposal> shortlisted(const BoundSimulator& bound, const Hypothesis& base,
                                                  const SearchProblem& problem,
                                                  const std::vector<AttachedEffect>& candidates, std::size_t count,
                                                  double least_gain, const Parallel& parallel) {
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
  // A mark that does not help as it is may do so once everything is fitted: such proposals fill what room is left.
  std::erase_if(proposals, [least_gain](const Proposal& one) {
    return one.distinct < 0.01 || (one.gain < least_gain && least_gain > 0.01);
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
                                                              const SelectionCriteria& options, double least,
                                                              const Parallel& parallel) {
  const std::vector<Proposal> proposals =
      shortlisted(bound, parent.hypothesis, problem, candidates, options.shortlist, least, parallel);
  std::vector<std::vector<Proposal>> singles;
  for (const Proposal& proposal : proposals) singles.push_back({proposal});
  const std::vector<Fit> fits =
      fit_children(bound, parent.hypothesis, singles, problem, options.finalists + 4, parallel);
  return evaluate_all(bound, fits, parent, problem, options.finalists, parallel);
}

SUREFOOT_INLINE std::vector<EvaluatedHypothesis> next_pairs(const BoundSimulator& bound,
                                                            const EvaluatedHypothesis& parent,
                                                            const SearchProblem& problem,
                                                            const std::vector<AttachedEffect>& candidates,
                                                            const Parallel& parallel) {
  const std::vector<Proposal> proposals =
      shortlisted(bound, parent.hypothesis, problem, candidates, 6, least_gain(true), parallel);
  std::vector<std::vector<Proposal>> pairs;
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    for (std::size_t j = i + 1; j < proposals.size(); ++j) {
      if (proposals[i].effect.effect->name == proposals[j].effect.effect->name) continue;
      pairs.push_back({proposals[i], proposals[j]});
    }
  }
  const std::vector<Fit> fits = fit_children(bound, parent.hypothesis, pairs, problem, 4, parallel);
  return evaluate_all(bound, fits, parent, problem, 2, parallel);
}

SUREFOOT_INLINE void drop_idle_effects(const Search& search, EvaluatedHypothesis& chosen) {
  std::size_t i = search.problem.known;
  while (search.effects(chosen) > 1 && i < chosen.hypothesis.effects.size() && !search.problem.stopped()) {
    const EvaluatedHypothesis less = search.without(chosen, i);
    const Comparison worth = compare_losses(less.heldout, chosen.heldout);
    if (worth.gain < search.options.min_gain / 2 || worth.t < 1.5) {
      chosen = less;
    } else {
      ++i;
    }
  }
}

SUREFOOT_INLINE void grow(const Search& search, Selection& selection) {
  const auto& [bound, problem, candidates, options, parallel] = search;
  const auto most = static_cast<std::size_t>(options.max_effects);
  while (search.effects(selection.chosen) < most && !problem.stopped()) {
    const std::size_t depth = search.effects(selection.chosen);
    problem.progress("searching effect " + std::to_string(depth + 1),
                     static_cast<double>(depth) / static_cast<double>(most));
    const bool structured = problem.structured(selection.chosen.hypothesis);
    std::vector<EvaluatedHypothesis> next =
        next_effects(bound, selection.chosen, problem, candidates, options, least_gain(structured), parallel);
    const double share = search.share(selection.chosen, selection.nominal);
    std::optional<std::size_t> choice = most_plausible_accepted(next, candidates.size(), share, options);
    if (!choice && structured && depth + 2 <= most && !problem.stopped()) {
      const std::vector<EvaluatedHypothesis> pairs = next_pairs(bound, selection.chosen, problem, candidates, parallel);
      choice = most_plausible_accepted(pairs, 15 * candidates.size(), share, options);
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
  const auto& [bound, problem, candidates, options, parallel] = search;
  if (search.effects(selection.chosen) != 1 || options.max_effects < 2 || problem.stopped()) return;
  if (!problem.structured(selection.chosen.hypothesis)) return;
  const std::vector<EvaluatedHypothesis> pairs = next_pairs(bound, selection.nominal, problem, candidates, parallel);
  if (pairs.empty()) return;
  const EvaluatedHypothesis& pair = pairs[most_plausible(pairs)];
  if (accepted(compare_losses(selection.chosen.heldout, pair.heldout), candidates.size(), 1, options)) {
    selection.chosen = pair;
  }
}

SUREFOOT_INLINE bool compare_with_others(const Search& search, Selection& selection, bool replace) {
  const auto& [bound, problem, candidates, options, parallel] = search;
  bool replaced = false;
  selection.evidence.clear();
  const bool alone = search.effects(selection.chosen) == 1;  // its rivals were judged when it was chosen
  if (!alone) selection.alternatives.clear();
  for (std::size_t i = problem.known; i < selection.chosen.hypothesis.effects.size() && !problem.stopped(); ++i) {
    problem.progress("comparing alternatives", 0.8);
    const EvaluatedHypothesis rest = alone ? selection.nominal : search.without(selection.chosen, i);
    if (!alone) {
      SelectionCriteria fewer = options;
      fewer.shortlist = 8;
      fewer.finalists = 3;
      std::vector<EvaluatedHypothesis> others =
          next_effects(bound, rest, problem, candidates, fewer, least_gain(true), parallel);
      std::erase_if(others, [&](const EvaluatedHypothesis& other) {
        return same_effect(other.hypothesis.effects.back(), selection.chosen.hypothesis.effects[i]);
      });
      const double before = search.share(rest, selection.nominal);
      for (EvaluatedHypothesis& other : others) {
        const Comparison lead = compare_losses(selection.chosen.heldout, other.heldout);
        if (replace && lead.t > 2 && lead.gain > 0.03 &&
            lead.gain * search.share(selection.chosen, selection.nominal) > 0.015 &&
            accepted(other.gain, candidates.size(), before, options)) {
          std::swap(selection.chosen, other);
          replaced = true;
        }
        selection.alternatives.push_back(other);
      }
    }
    selection.evidence.push_back(compare_losses(rest.heldout, selection.chosen.heldout));
  }
  return replaced;
}

SUREFOOT_INLINE Selection select_effects(const BoundSimulator& bound, const Fit& calibrated,
                                         const SearchProblem& problem, const std::vector<AttachedEffect>& candidates,
                                         const SelectionCriteria& options, const Parallel& parallel) {
  const Search search{bound, problem, candidates, options, parallel};
  Selection selection;
  selection.candidates = candidates.size();
  selection.nominal = judge(bound, calibrated, problem, parallel);
  selection.chosen = selection.nominal;
  grow(search, selection);
  try_pair_instead(search, selection);
  if (search.effects(selection.chosen) == 0) return selection;
  if (compare_with_others(search, selection, true)) {
    drop_idle_effects(search, selection.chosen);
    compare_with_others(search, selection, false);
  }
  return selection;
}

}  // namespace surefoot::diagnosis
