// Criteria of the selection: which of several hypotheses is the most plausible, and whether a gain is to be believed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/diagnose/estimation/cross_validation.hpp"

namespace surefoot::diagnosis {

/// When an effect is believed, dropped or replaced. A gain is a share of the root mean square error, cross-validated; a
/// t is a gain in its standard errors.
struct SelectionCriteria {
  int max_effects = 4;  // to combine; more of them can rarely be told apart

  // An effect is believed:
  double min_gain = 0.03;                 // smaller gains are within what a slightly wrong form of an effect takes away
  double min_t = 2.5;                     // one-sided 0.6 %
  double significance = 0.02;             // after correction for the number of candidates (Bonferroni)
  double large_gain = 0.1;                // is believed without that correction: it may come from few recordings
  double large_gain_significance = 0.05;  // one-sided, of that test alone
  double least_share = 0.03;              // of the error without effects, that an effect must take away
  double decisive_gain = 0.5;             // or of the error that is left, however small that is
  double tests_per_pair = 15;             // a pair pays for all pairs of six proposals, by candidate

  // Of several that are believed, the simplest that is not clearly worse than the best:
  double tie_gain = 0.01;         // the best gains no more than this: a tie
  double tie_t = 1.5;             // or no more than this, against a hypothesis with fewer parameters
  double tie_gain_share = 0.985;  // or has no more than this share of the best one's gain

  // An effect among others is dropped again:
  double idle_gain = 0.015;  // half of min_gain: it was worth that much when it was chosen
  double idle_t = 1.5;       // one-sided 7 %: it may well be chance

  // An effect is replaced by another one:
  double replace_gain = 0.03;    // as much as an effect must gain
  double replace_t = 2;          // one-sided 2 %: the first choice was the best at its time
  double replace_share = 0.015;  // of the error without effects: of a small rest nobody sees the difference

  // Parameters:
  double determined_deviations = 2;  // standard errors that a parameter lies from zero: about 95 %

  // Residuals hold what noise does not:
  double structure_significance = 0.02;  // as for effects; the verdict asks for more, see VerdictCriteria
  double structure_share = 0.03;         // of their mean square: less is not worth a parameter

  // Proposals that get no fit:
  double least_distinct = 0.01;  // share of a signature beyond the model's parameters: below, they do it
  double unstructured_proposal_gain =
      0.012;  // share of the squared residuals, if these look like noise: more than chance

  // Inputs and signals that are multiples of one before:
  double collinear = 1 - 1e-9;  // cosine; what rounding leaves of 1
};

/// How much is tried: time against thoroughness. No result is believed or refused by these.
struct SearchEffort {
  std::size_t shortlist = 14;                // proposals that get a fit
  std::size_t max_shortlist = 50;            // of small problems
  double shortlist_rows = 6000;              // of the recordings, up to which the list is longer in proportion
  std::size_t finalists = 4;                 // fits that are cross-validated
  std::size_t max_finalists = 9;             // with near ties
  double near_tie = 1.05;                    // loss against the best one's: fits this close may change places
  std::size_t reserve = 4;                   // fits beyond the finalists that are finished
  std::size_t screening = 5;                 // recordings that proposals are made from
  std::size_t screening_final_poses = 1000;  // the same where each has a pose only
  int first_iterations = 3;                  // of a fit, before the weakest are given up
  double weak_start = 0.3;                   // of the strength that the linear guess says, if that was too bold:
  double bold_loss = 0.97;                   // it was, if the loss is still above this
  std::size_t more_starts = 2;               // for effects that have no strength
  std::size_t scattered_points = 12;         // for the model's parameters beside the first effect
  std::size_t paired = 6;                    // proposals that pairs are made of
  std::size_t pair_reserve = 4;              // fits of pairs that are finished
  std::size_t pair_finalists = 2;
  std::size_t compared_shortlist = 8;  // for what may stand in an effect's place
  std::size_t compared_finalists = 3;  // fits of these that are finished
  int fold_iterations = 6;             // of the fit to each fold, which starts from the fit to all
  double fold_tolerance = 1e-3;        // relative decrease of its loss at which it ends
};

/// A hypothesis with its cross-validated losses.
struct EvaluatedHypothesis {
  Hypothesis hypothesis;
  double loss = 0;  // on the recordings of the fit
  BlockLosses cross_validated;
  Comparison gain;  // against its parent

  /// Parameters of all effects.
  std::size_t parameter_count() const {
    std::size_t count = 0;
    for (const Eigen::VectorXd& values : hypothesis.values) count += static_cast<std::size_t>(values.size());
    return count;
  }
};

/// The subject of a search, and how to go about it.
struct SearchProblem {
  FitProblem fit;                               // all recordings but those held out
  std::vector<std::vector<std::size_t>> folds;  // of the same recordings
  std::vector<std::size_t> screened;            // the part of them that screens proposals
  std::size_t known = 0;  // effects that are part of the model already: the first ones, never removed
  /// Whether the residuals of a hypothesis still hold what noise does not; where not, only strong proposals get a fit.
  std::function<bool(const Hypothesis&)> structured = [](const Hypothesis&) { return true; };
  std::function<void(const std::string&, double)> on_progress = [](const std::string&, double) {};
  std::function<bool()> stopped = [] { return false; };
  SelectionCriteria criteria = {};
  SearchEffort effort = {};
};

/// Cross-validates a fit.
EvaluatedHypothesis evaluate_fit(const BoundSimulator& bound, const Fit& fitted, const SearchProblem& problem,
                                 const Parallel& parallel);

/// Fewer parameters, or as many with effects that stand earlier in the catalogue (which begins with the simplest).
bool simpler(const Hypothesis& a, const Hypothesis& b);

/// The simplest of those that are not clearly worse than the best.
std::size_t most_plausible(const std::vector<EvaluatedHypothesis>& evaluated, const SelectionCriteria& criteria = {});

/// Whether a gain is to be believed after `tests` of them. `parent` is the error before, as a share of the error
/// without effects.
bool accepted(const Comparison& gain, double tests, double parent, const SelectionCriteria& criteria);

/// The most plausible of those whose gain is to be believed, if there is one.
std::optional<std::size_t> most_plausible_accepted(const std::vector<EvaluatedHypothesis>& evaluated, double tests,
                                                   double parent, const SelectionCriteria& criteria);

/// An effect that adds nothing among others.
inline bool idle(const Comparison& worth, const SelectionCriteria& criteria) {
  return worth.gain < criteria.idle_gain || worth.t < criteria.idle_t;
}

/// Whether what leads by this much takes an effect's place; `error` is that of the choice, as a share of the error
/// without effects.
inline bool replaces(const Comparison& lead, double error, const SelectionCriteria& criteria) {
  return lead.t > criteria.replace_t && lead.gain > criteria.replace_gain && lead.gain * error > criteria.replace_share;
}

/// Whether each effect beyond the first `known` has a parameter that recordings tell from zero: one of its strengths
/// or, where it has none, its first.
bool determined(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t known, const FitProblem& problem,
                const Parallel& parallel, const SelectionCriteria& criteria = {});

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/criterion.ipp"
#endif
