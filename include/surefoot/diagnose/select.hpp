// Selects effects by a floating forward-backward search (Pudil, Novovicova & Kittler, "Floating search methods in
// feature selection", 1994) on held-out recordings. Effects mask each other: proposals are ranked anew after every
// step, and pairs are tried where no single effect is worth its parameters. Each fit starts from that of its parent.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "surefoot/diagnose/calibrate.hpp"
#include "surefoot/diagnose/judge.hpp"
#include "surefoot/diagnose/propose.hpp"

namespace surefoot {

struct Selection {
  Judged nominal;  // without effects
  Judged chosen;
  std::vector<Comparison> evidence;  // by chosen effect: against the choice without it
  std::vector<Judged> alternatives;  // one effect replaced, or none chosen: the best that was refused
  std::size_t candidates = 0;        // how many were tried
};

namespace detail {

/// Fits parent plus proposals, all at once in parallel; the weakest are given up after a few iterations.
inline std::vector<Fit> fit_children(const Rig& rig, const Hypothesis& parent,
                                     const std::vector<std::vector<Proposal>>& additions, const SelectProblem& problem,
                                     std::size_t keep, const Parallel& parallel) {
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
        child = fit(rig, child, around, serially()).hypothesis;
      }
      const Fit one = fit(rig, child, quick, serially());
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
    fits[i] = fit(rig, fits[i].hypothesis, problem.fit, serially());
    // what is missing may have pushed the calibrated parameters where no fit finds back from
    if (parent.effects.size() == problem.known) {
      fits[i] = scattered_fit(rig, fits[i], fits[i].hypothesis, problem.fit, 12, 1, serially());
    }
  });
  std::ranges::sort(fits, [](const Fit& a, const Fit& b) { return a.loss < b.loss; });
  return fits;
}

inline std::vector<Judged> judge_all(const Rig& rig, const std::vector<Fit>& fits, const Judged& parent,
                                     const SelectProblem& problem, std::size_t keep, const Parallel& parallel) {
  while (keep < fits.size() && fits[keep].loss < 1.05 * fits.front().loss + 1e-300 && keep < 9) ++keep;  // near ties
  std::vector<Judged> judged(std::min(keep, fits.size()));
  parallel(judged.size(), [&](std::size_t i) {
    if (problem.stopped()) return;
    judged[i] = judge(rig, fits[i], problem, serially());
    judged[i].gain = compare_scores(parent.heldout, judged[i].heldout);
    // numbers that cannot be told from zero speak against what was added, and against what that leaves undetermined
    if (!determined(rig, fits[i].hypothesis, problem.known, problem.fit, serially())) judged[i].heldout = {};
  });
  std::erase_if(judged, [](const Judged& one) { return one.heldout.blocks.empty(); });
  return judged;
}

inline std::vector<Proposal> shortlisted(const Rig& rig, const Hypothesis& base, const SelectProblem& problem,
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
  std::vector<Proposal> proposals = propose(rig, base, screened, open, parallel);
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

inline Hypothesis without(const Hypothesis& whole, std::size_t effect) {
  Hypothesis rest = whole;
  rest.effects.erase(rest.effects.begin() + static_cast<std::ptrdiff_t>(effect));
  rest.values.erase(rest.values.begin() + static_cast<std::ptrdiff_t>(effect));
  return rest;
}

}  // namespace detail

/// What a proposal must explain of the squared residuals before it gets a fit.
inline double least_gain(bool structured) { return structured ? 0.002 : 0.012; }

/// One round: the effects (or pairs) that would come next after `parent`, judged; best first.
inline std::vector<Judged> next_effects(const Rig& rig, const Judged& parent, const SelectProblem& problem,
                                        const std::vector<AttachedEffect>& candidates, const SelectOptions& options,
                                        double least, const Parallel& parallel) {
  const std::vector<Proposal> proposals =
      detail::shortlisted(rig, parent.hypothesis, problem, candidates, options.shortlist, least, parallel);
  std::vector<std::vector<Proposal>> singles;
  for (const Proposal& proposal : proposals) singles.push_back({proposal});
  const std::vector<Fit> fits =
      detail::fit_children(rig, parent.hypothesis, singles, problem, options.finalists + 4, parallel);
  return detail::judge_all(rig, fits, parent, problem, options.finalists, parallel);
}

/// The same for pairs of the six best proposals.
inline std::vector<Judged> next_pairs(const Rig& rig, const Judged& parent, const SelectProblem& problem,
                                      const std::vector<AttachedEffect>& candidates, const Parallel& parallel) {
  const std::vector<Proposal> proposals =
      detail::shortlisted(rig, parent.hypothesis, problem, candidates, 6, least_gain(true), parallel);
  std::vector<std::vector<Proposal>> pairs;
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    for (std::size_t j = i + 1; j < proposals.size(); ++j) {
      if (proposals[i].effect.effect->name == proposals[j].effect.effect->name) continue;
      pairs.push_back({proposals[i], proposals[j]});
    }
  }
  const std::vector<Fit> fits = detail::fit_children(rig, parent.hypothesis, pairs, problem, 4, parallel);
  return detail::judge_all(rig, fits, parent, problem, 2, parallel);
}

/// The whole search, from a fitted hypothesis without effects.
inline Selection select_effects(const Rig& rig, const Fit& calibrated, SelectProblem problem,
                                const std::vector<AttachedEffect>& candidates, const SelectOptions& options,
                                const Parallel& parallel) {
  Selection selection;
  selection.candidates = candidates.size();
  selection.nominal = detail::judge(rig, calibrated, problem, parallel);
  selection.chosen = selection.nominal;
  std::vector<Judged> refused;
  const std::size_t known = problem.known, most = known + static_cast<std::size_t>(options.max_effects);
  while (selection.chosen.hypothesis.effects.size() < most && !problem.stopped()) {
    const auto depth = static_cast<double>(selection.chosen.hypothesis.effects.size() - known);
    problem.progress("searching effect " + std::to_string(static_cast<int>(depth) + 1), depth / options.max_effects);
    const bool structured = problem.structured(selection.chosen.hypothesis);
    std::vector<Judged> next =
        next_effects(rig, selection.chosen, problem, candidates, options, least_gain(structured), parallel);
    const double share = selection.chosen.heldout.rms() / std::max(selection.nominal.heldout.rms(), 1e-300);
    std::optional<std::size_t> choice = detail::most_plausible_accepted(next, candidates.size(), share, options);
    if (!choice && structured && selection.chosen.hypothesis.effects.size() + 2 <= most && !problem.stopped()) {
      const std::vector<Judged> pairs = next_pairs(rig, selection.chosen, problem, candidates, parallel);
      choice = detail::most_plausible_accepted(pairs, 15 * candidates.size(), share, options);
      if (choice) next = pairs;
    }
    if (!choice) {
      refused = next;
      break;
    }
    selection.chosen = next[*choice];
    next.erase(next.begin() + static_cast<std::ptrdiff_t>(*choice));
    selection.alternatives = next;
    // Backward: whatever is no longer worth its numbers goes.
    for (std::size_t i = known;
         selection.chosen.hypothesis.effects.size() > known + 1 && i < selection.chosen.hypothesis.effects.size();) {
      const Fit less = fit(rig, detail::without(selection.chosen.hypothesis, i), problem.fit, parallel);
      const Judged judged = detail::judge(rig, less, problem, parallel);
      const Comparison worth = compare_scores(judged.heldout, selection.chosen.heldout);
      if (worth.gain < options.min_gain / 2 || worth.t < 1.5) {
        selection.chosen = judged;
      } else {
        ++i;
      }
    }
  }
  // One effect that leaves something open may have hidden two that do better.
  if (selection.chosen.hypothesis.effects.size() == known + 1 && most >= known + 2 && !problem.stopped() &&
      problem.structured(selection.chosen.hypothesis)) {
    const std::vector<Judged> pairs = next_pairs(rig, selection.nominal, problem, candidates, parallel);
    if (!pairs.empty()) {
      Judged pair = pairs[detail::most_plausible(pairs)];
      if (detail::accepted(compare_scores(selection.chosen.heldout, pair.heldout), candidates.size(), 1, options)) {
        selection.chosen = std::move(pair);
      }
    }
  }
  if (selection.chosen.hypothesis.effects.size() == known) {
    selection.alternatives = refused;
    return selection;
  }
  // Each effect against what else might stand in its place.
  if (selection.chosen.hypothesis.effects.size() > known + 1) selection.alternatives.clear();
  for (int round = 0; round < 2; ++round) {
    bool swapped = false;
    selection.evidence.clear();
    for (std::size_t i = known; i < selection.chosen.hypothesis.effects.size() && !problem.stopped(); ++i) {
      problem.progress("comparing alternatives", 0.8);
      const bool alone = selection.chosen.hypothesis.effects.size() == known + 1;
      Judged rest = selection.nominal;
      if (!alone) {
        rest = detail::judge(rig, fit(rig, detail::without(selection.chosen.hypothesis, i), problem.fit, parallel),
                             problem, parallel);
        SelectOptions fewer = options;
        fewer.shortlist = 8;
        fewer.finalists = 3;
        std::vector<Judged> others = next_effects(rig, rest, problem, candidates, fewer, least_gain(true), parallel);
        std::erase_if(others, [&](const Judged& other) {
          return same_effect(other.hypothesis.effects.back(), selection.chosen.hypothesis.effects[i]);
        });
        for (Judged& other : others) {
          const Comparison lead = compare_scores(selection.chosen.heldout, other.heldout);
          const double share = selection.chosen.heldout.rms() / std::max(selection.nominal.heldout.rms(), 1e-300);
          if (round == 0 && lead.t > 2 && lead.gain > 0.03 && lead.gain * share > 0.015) {
            std::swap(selection.chosen, other);
            swapped = true;
          }
          selection.alternatives.push_back(other);
        }
      }
      selection.evidence.push_back(compare_scores(rest.heldout, selection.chosen.heldout));
    }
    if (!swapped) break;
    selection.alternatives.clear();
  }
  return selection;
}

}  // namespace surefoot
