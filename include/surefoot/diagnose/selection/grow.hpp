// Growth of the pool of structures: the best of them are each extended by a further effect, or by a pair where no
// single one is worth its parameters. Weights follow what the best one so far leaves.
#pragma once

#include <vector>

#include "surefoot/diagnose/selection/children.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"

namespace surefoot::diagnosis {

/// Puts a hypothesis into the pool, in the place of another form of the same structure if it is better or leaves no
/// more with fewer parameters; true if it went in.
bool keep_best_form(std::vector<EvaluatedHypothesis>& pool, const EvaluatedHypothesis& one,
                    const SelectionCriteria& criteria);

/// Weights residuals of further fits by what a hypothesis leaves of each output and recording, and screens proposals on
/// the recordings that show this best.
void reweight(Search& search, const EvaluatedHypothesis& best);

/// What effects explain shows smaller errors of the integration, which would pass for further effects: chooses it anew
/// for what a hypothesis leaves; true if it is finer now.
bool refine_integration(Search& search, const EvaluatedHypothesis& best);

/// Whether a hypothesis leaves more than noise: what leaves only noise needs no second effect, nor another start.
bool leaves_structure(const Search& search, const EvaluatedHypothesis& one);

/// A hypothesis, fitted and evaluated again.
EvaluatedHypothesis refitted(const Search& search, const Hypothesis& one);

/// Richer forms for the best structures, none of them `hopeless` behind the best [nat].
void enrich(const Search& search, std::vector<EvaluatedHypothesis>& pool, double hopeless);

/// The children of one parent into the pool of children; no fits for what cannot come near the best structure so far.
void extend(const Search& search, const EvaluatedHypothesis& parent, const EvaluatedHypothesis& best,
            std::vector<EvaluatedHypothesis>& children);

/// The children of the model without effects, but with the parameters and initial states of `start`: what is missing
/// may have pushed the calibrated ones where no fit finds back from, and where signatures look otherwise. With a `best`
/// structure so far, only what could come near it.
std::vector<EvaluatedHypothesis> extended_from(Search search, Hypothesis start, const EvaluatedHypothesis* best);

/// The same under guidance (guided_fit.hpp): signatures and first fits along the readings, wherever the calibrated
/// model has run to, and at the end fits of whole recordings.
std::vector<EvaluatedHypothesis> extended_under_guidance(const Search& search);

/// Where first effects leave more than noise: the best from places around, first effects under guidance and from the
/// nominal parameters on, and pairs of the best.
void begin_elsewhere(Search search, std::vector<EvaluatedHypothesis>& children);

/// Whether the rival explanation of the problem does better than the best of a pool of first effects.
bool yields(const Search& search, const std::vector<EvaluatedHypothesis>& pool);

/// Fits children that a bound of an effect alone makes less probable than the best structure once more from inside:
/// where a scale is free, as of a tank that no sensor sees, nothing but chance puts them there.
void draw_inside(const Search& search, const EvaluatedHypothesis& best, std::vector<EvaluatedHypothesis>& children);

/// Whether a structure has effects and is more probable than the model without any, these two alone compared: beside a
/// third one that comes nearer it may look so and not be.
bool pays(const Search& search, const EvaluatedHypothesis& one, const std::vector<EvaluatedHypothesis>& pool);

/// Adds a structure, and what it is without any one of its effects if that leaves hardly more: room for others.
void add_with_smaller(const Search& search, const EvaluatedHypothesis& one, std::vector<EvaluatedHypothesis>& beam);

/// Extends the best structures of a pool, as long as that makes the best one better; once more where no first effect
/// does and something is left, and on as long as the closest structure comes much nearer each time: that one is then
/// extended whatever its odds, and without what it holds idle. What the best one can do without is taken away at once
/// (floating search; P. Pudil, J. Novovicova, J. Kittler, Pattern Recognition Letters 15, 1994). Structures with an
/// effect that does nothing, and those far behind, are not extended, nor is what was before, which `done` keeps, with
/// the same recordings and integration.
void grow(Search& search, std::vector<EvaluatedHypothesis>& pool, std::vector<Hypothesis>& done);

/// The best structures, and the model without effects, fitted and evaluated with the present weights and recordings.
std::vector<EvaluatedHypothesis> fitted_again(const Search& search, const std::vector<EvaluatedHypothesis>& pool);

/// Fits the best of a pool from places around, with a growing horizon and under guidance, where they leave more than
/// noise: another effect would only mend a fit that ended in a valley.
void try_around(const Search& search, std::vector<EvaluatedHypothesis>& pool);

/// A structure without each of its effects in turn, fitted from its parameters on; none for a single effect.
std::vector<EvaluatedHypothesis> smaller(const Search& search, const EvaluatedHypothesis& whole);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/grow.ipp"
#endif
