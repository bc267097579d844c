// Ranking of all structures that a search has evaluated: which is chosen, how probable it is, what its effects gain.
#pragma once

#include <cstddef>
#include <vector>

#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/selection/children.hpp"

namespace surefoot::diagnosis {

struct Selection {
  EvaluatedHypothesis nominal;  // without effects
  EvaluatedHypothesis chosen;
  double probability = 1;                         // posterior, of the chosen structure
  std::vector<Comparison> evidence;               // by chosen effect: against the choice without it
  std::vector<EvaluatedHypothesis> alternatives;  // all other structures that were evaluated, the most probable first
  std::vector<double> alternative_probabilities;  // of these
  std::size_t candidates = 0;                     // how many effects and places were tried
  FitProblem fit;                                 // as the choice was fitted in the end
  bool yields = false;                            // to a rival explanation: first effects do worse
};

/// Of an error: what leaves less comes clearly nearer.
inline constexpr double clearly_nearer = 0.8;

/// Of the structures that were not chosen, the one that leaves least of recordings, by the geometric mean of their
/// errors, if that is clearly less than the choice leaves; else the choice.
const EvaluatedHypothesis& clearly_nearest(const Selection& selection);

/// What the errors gain, each output's in units of what it was before, with its standard error over recordings; the
/// p-value is that of the odds.
Comparison gain_of(const ErrorSquares& before, const ErrorSquares& after, double log_odds);

/// Of the structures that cannot be told apart from the most probable one, `best`, and have no more parameters than it,
/// the closest: what counts as an error of form between structures still says which of them to start with.
std::size_t closest_of_tie(const Search& search, const std::vector<EvaluatedHypothesis>& pool,
                           const std::vector<double>& share, std::size_t best);

/// The structure `whole`, or, in the tie with the most probable one, a part of it, if each effect that goes with the
/// rest is less probable than not, over all structures (median probability model; M. M. Barbieri, J. O. Berger,
/// "Optimal predictive model selection", Annals of Statistics 32(3), 2004): what may as well be absent is not named.
/// Two effects that look the same may each be less probable than not, and one of them needed: a part that leaves more
/// than noise does not stand for a whole that leaves no more.
std::size_t without_improbable(const Search& search, const std::vector<EvaluatedHypothesis>& pool,
                               const std::vector<double>& share, std::size_t whole);

/// The most probable structure, if it is to be named, and all others in their order.
Selection ranked(const Search& search, const std::vector<EvaluatedHypothesis>& pool);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/ranking.ipp"
#endif
