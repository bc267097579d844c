// Judges hypotheses on held-out recordings: how well one does, which of several is the most plausible, whether a gain
// is to be believed.
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

struct SelectionCriteria {
  int max_effects = 4;
  double min_gain = 0.03;      // share of the held-out error that an effect must take away
  double min_t = 2.5;          // and in standard errors of that gain
  double significance = 0.02;  // after correction for the number of candidates
  double least_share = 0.03;   // of the error without effects, that an effect must take away
  double decisive_gain = 0.5;  // or of the error that is left
  double large_gain = 0.1;     // is believed without that correction: it may come from few recordings
  double large_gain_significance = 0.05;
  std::size_t shortlist = 14;  // proposals that get a fit
  std::size_t finalists = 4;   // fits that are judged on held-out recordings
};

/// A hypothesis with its held-out score.
struct EvaluatedHypothesis {
  Hypothesis hypothesis;
  double loss = 0;  // on the recordings of the fit
  BlockLosses heldout;
  Comparison gain;  // against its parent

  std::size_t numbers() const {
    std::size_t count = 0;
    for (const Eigen::VectorXd& values : hypothesis.values) count += static_cast<std::size_t>(values.size());
    return count;
  }
};

/// What a search works on.
struct SearchProblem {
  FitProblem fit;                               // all recordings but the test
  std::vector<std::vector<std::size_t>> folds;  // of the same recordings
  std::vector<std::size_t> screened;            // the part of them that screens proposals
  std::size_t known = 0;  // effects that are part of the model already: the first ones, never removed
  /// Whether the residuals of a hypothesis still hold what noise does not; where not, only strong proposals get a fit.
  std::function<bool(const Hypothesis&)> structured = [](const Hypothesis&) { return true; };
  std::function<void(const std::string&, double)> progress = [](const std::string&, double) {};
  std::function<bool()> stopped = [] { return false; };
};

EvaluatedHypothesis judge(const BoundSimulator& bound, const Fit& fitted, const SearchProblem& problem,
                          const Parallel& parallel);

/// Fewer numbers, or as many with effects that stand earlier in the catalogue (which begins with the simplest).
bool simpler(const Hypothesis& a, const Hypothesis& b);

/// The best of some judged hypotheses: the fewest numbers among those that are not clearly worse than the best.
std::size_t most_plausible(const std::vector<EvaluatedHypothesis>& judged);

/// `parent` is the error before, as a share of the error without effects.
bool accepted(const Comparison& gain, std::size_t tried, double parent, const SelectionCriteria& options);

/// The most plausible of those whose gain is to be believed, if there is one.
std::optional<std::size_t> most_plausible_accepted(const std::vector<EvaluatedHypothesis>& judged, std::size_t tried,
                                                   double parent, const SelectionCriteria& options);

/// Whether each effect beyond the first `known` has a number that recordings tell from zero: one of its strengths or,
/// where it has none, its first.
bool determined(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t known, const FitProblem& problem,
                const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/criterion.ipp"
#endif
