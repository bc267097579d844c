// Selects effects by a floating forward-backward search (Pudil, Novovicova & Kittler, "Floating search methods in
// feature selection", 1994) on held-out recordings. Effects mask each other: proposals are ranked anew after every
// step, and pairs are tried where no single effect is worth its parameters. Each fit starts from that of its parent.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "surefoot/diagnose/propose.hpp"
#include "surefoot/diagnose/score.hpp"

namespace surefoot {

struct SelectOptions {
  int max_effects = 4;
  double min_gain = 0.03;      // share of the held-out error that an effect must take away
  double min_t = 2.5;          // and in standard errors of that gain
  double significance = 0.02;  // after correction for the number of candidates
  double least_share = 0.03;   // of the error without effects, that an effect must take away
  double decisive_gain = 0.5;  // or of the error that is left
  double large_gain = 0.1;     // is believed at 0.005 without that correction: it may come from few recordings
  std::size_t known = 0;       // effects that are part of the model already: the first ones, never removed
  std::size_t shortlist = 14;  // proposals that get a fit
  std::size_t finalists = 4;   // fits that are judged on held-out recordings
};

/// A hypothesis with its held-out score.
struct Judged {
  Hypothesis hypothesis;
  double loss = 0;  // on the recordings of the fit
  Score heldout;
  Comparison gain;  // against its parent

  std::size_t numbers() const {
    std::size_t count = 0;
    for (const Eigen::VectorXd& values : hypothesis.values) count += static_cast<std::size_t>(values.size());
    return count;
  }
};

struct Selection {
  Judged nominal;  // without effects
  Judged chosen;
  std::vector<Comparison> evidence;  // by chosen effect: against the choice without it
  std::vector<Judged> alternatives;  // one effect replaced, or none chosen: the best that was refused
  std::size_t candidates = 0;        // how many were tried
};

/// What a search works on.
struct SelectProblem {
  FitProblem fit;                               // all recordings but the test
  std::vector<std::vector<std::size_t>> folds;  // of the same recordings
  std::vector<std::size_t> screened;            // the part of them that screens proposals
  /// Whether the residuals of a hypothesis still hold what noise does not; where not, only strong proposals get a fit.
  std::function<bool(const Hypothesis&)> structured = [](const Hypothesis&) { return true; };
  std::function<void(const std::string&, double)> progress = [](const std::string&, double) {};
  std::function<bool()> stopped = [] { return false; };
};

namespace detail {

inline Judged judge(const Rig& rig, const Fit& fitted, const SelectProblem& problem, const Parallel& parallel) {
  Judged result{fitted.hypothesis, fitted.loss, {}, {}};
  FitProblem quick = problem.fit;
  quick.max_iterations = 6;
  quick.tolerance = 1e-3;
  result.heldout = cross_validate(rig, fitted.hypothesis, quick, problem.folds, parallel).score;
  return result;
}

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
    const auto attempt = [&](const std::vector<Eigen::VectorXd>& starts) {
      Hypothesis child = parent;
      for (std::size_t k = 0; k < starts.size(); ++k) {
        child.effects.push_back(additions[i][k].effect);
        child.values.push_back(starts[k]);
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
    attempt(best);
    const bool scalable = best != weak;
    if (scalable && !(fits[i].loss < 0.97)) attempt(weak);  // the linear guess may have been too bold
    if (!scalable && additions[i].size() == 1) {
      const auto& others = additions[i].front().more_starts;
      for (std::size_t k = 0; k < std::min<std::size_t>(2, others.size()); ++k) attempt({others[k]});
    }
  });
  std::erase_if(fits, [](const Fit& one) { return !one.ok; });
  std::ranges::sort(fits, [](const Fit& a, const Fit& b) { return a.loss < b.loss; });
  if (fits.size() > keep) fits.resize(keep);
  parallel(fits.size(), [&](std::size_t i) {
    if (!problem.stopped()) fits[i] = fit(rig, fits[i].hypothesis, problem.fit, serially());
  });
  std::ranges::sort(fits, [](const Fit& a, const Fit& b) { return a.loss < b.loss; });
  return fits;
}

/// Fewer numbers, or as many with effects that stand earlier in the catalogue (which begins with the simplest).
inline bool simpler(const Hypothesis& a, const Hypothesis& b) {
  const auto measure = [](const Hypothesis& h) {
    std::pair<std::size_t, int> sum{0, 0};
    for (std::size_t e = 0; e < h.effects.size(); ++e) {
      sum.first += static_cast<std::size_t>(h.values[e].size());
      sum.second += h.effects[e].rank;
    }
    return sum;
  };
  return measure(a) < measure(b);
}

/// The best of some judged hypotheses: the fewest numbers among those that are not clearly worse than the best.
inline std::size_t most_plausible(const std::vector<Judged>& judged) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < judged.size(); ++i) {
    if (judged[i].heldout.total() < judged[best].heldout.total()) best = i;
  }
  std::size_t choice = best;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (i == best || !simpler(judged[i].hypothesis, judged[choice].hypothesis)) continue;
    const Comparison lead = compare_scores(judged[i].heldout, judged[best].heldout);
    const bool fewer = judged[i].numbers() < judged[choice].numbers();
    const bool all_but = judged[i].gain.gain >= 0.985 * judged[best].gain.gain && judged[i].gain.gain > 0;
    if (lead.gain < 0.01 || (fewer && lead.t < 1.5) || all_but) choice = i;
  }
  return choice;
}

/// `parent` is the error before, as a share of the error without effects.
inline bool accepted(const Comparison& gain, std::size_t tried, double parent, const SelectOptions& options) {
  if (gain.gain * parent < options.least_share && gain.gain < options.decisive_gain) return false;
  const bool significant = gain.p_value * static_cast<double>(std::max<std::size_t>(1, tried)) <= options.significance;
  return gain.gain >= options.min_gain && gain.t >= options.min_t &&
         (significant || (gain.gain >= options.large_gain && gain.p_value <= 0.005));
}

inline std::vector<Judged> judge_all(const Rig& rig, const std::vector<Fit>& fits, const Judged& parent,
                                     const SelectProblem& problem, std::size_t keep, const Parallel& parallel) {
  while (keep < fits.size() && fits[keep].loss < 1.05 * fits.front().loss + 1e-300 && keep < 9) ++keep;  // near ties
  std::vector<Judged> judged(std::min(keep, fits.size()));
  parallel(judged.size(), [&](std::size_t i) {
    if (problem.stopped()) return;
    judged[i] = judge(rig, fits[i], problem, serially());
    judged[i].gain = compare_scores(parent.heldout, judged[i].heldout);
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
  const std::size_t known = options.known, most = known + static_cast<std::size_t>(options.max_effects);
  while (selection.chosen.hypothesis.effects.size() < most && !problem.stopped()) {
    const auto depth = static_cast<double>(selection.chosen.hypothesis.effects.size() - known);
    problem.progress("searching effect " + std::to_string(static_cast<int>(depth) + 1), depth / options.max_effects);
    const bool structured = problem.structured(selection.chosen.hypothesis);
    std::vector<Judged> next =
        next_effects(rig, selection.chosen, problem, candidates, options, least_gain(structured), parallel);
    const double share = selection.chosen.heldout.rms() / std::max(selection.nominal.heldout.rms(), 1e-300);
    std::size_t tried = candidates.size(), choice = next.empty() ? 0 : detail::most_plausible(next);
    if ((next.empty() || !detail::accepted(next[choice].gain, tried, share, options)) && structured &&
        selection.chosen.hypothesis.effects.size() + 2 <= most && !problem.stopped()) {
      const std::vector<Judged> pairs = next_pairs(rig, selection.chosen, problem, candidates, parallel);
      if (!pairs.empty()) {
        const std::size_t pair = detail::most_plausible(pairs);
        if (detail::accepted(pairs[pair].gain, tried * 15, share, options)) {
          next = pairs;
          choice = pair;
          tried *= 15;
        }
      }
    }
    if (next.empty()) break;
    if (!detail::accepted(next[choice].gain, tried, share, options)) {
      refused = next;
      break;
    }
    selection.chosen = next[choice];
    refused.clear();
    next.erase(next.begin() + static_cast<std::ptrdiff_t>(choice));
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
