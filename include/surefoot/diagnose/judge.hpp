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

#include "surefoot/diagnose/score.hpp"

namespace surefoot {

struct SelectOptions {
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

/// What a search works on.
struct SelectProblem {
  FitProblem fit;                               // all recordings but the test
  std::vector<std::vector<std::size_t>> folds;  // of the same recordings
  std::vector<std::size_t> screened;            // the part of them that screens proposals
  std::size_t known = 0;  // effects that are part of the model already: the first ones, never removed
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
         (significant || (gain.gain >= options.large_gain && gain.p_value <= options.large_gain_significance));
}

/// The most plausible of those whose gain is to be believed, if there is one.
inline std::optional<std::size_t> most_plausible_accepted(const std::vector<Judged>& judged, std::size_t tried,
                                                          double parent, const SelectOptions& options) {
  std::vector<Judged> believed;
  std::vector<std::size_t> place;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (!accepted(judged[i].gain, tried, parent, options)) continue;
    believed.push_back(judged[i]);
    place.push_back(i);
  }
  if (believed.empty()) return std::nullopt;
  return place[most_plausible(believed)];
}

/// Whether each effect beyond the first `known` has a number that recordings tell from zero: one of its strengths or,
/// where it has none, its first.
inline bool determined(const Rig& rig, const Hypothesis& hypothesis, std::size_t known, const FitProblem& problem,
                       const Parallel& parallel) {
  const StandardErrors errors = standard_errors(rig, hypothesis, problem, parallel);
  std::vector<bool> seen(hypothesis.effects.size(), false);
  for (std::size_t i = 0; i < errors.variables.size(); ++i) {
    const Variable& variable = errors.variables[i];
    if (variable.kind != Variable::Kind::effect) continue;
    const auto& parameters = hypothesis.effects[variable.index].effect->parameters;
    const bool any_strength = std::ranges::any_of(parameters, &EffectParameter::strength);
    if (any_strength ? !parameters[variable.item].strength : variable.item > 0) continue;
    const double value = hypothesis.values[variable.index][static_cast<Eigen::Index>(variable.item)];
    if (std::abs(value) > 2 * errors.deviation[static_cast<Eigen::Index>(i)]) seen[variable.index] = true;
  }
  return std::all_of(seen.begin() + static_cast<std::ptrdiff_t>(known), seen.end(), [](bool one) { return one; });
}

}  // namespace detail

}  // namespace surefoot
