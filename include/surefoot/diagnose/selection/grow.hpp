// Growth of the pool of structures: the best of them are each extended, until that makes none better.
#pragma once

#include <vector>

#include "surefoot/diagnose/selection/children.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"

namespace surefoot::diagnosis {

/// Fits children that a bound of an effect alone makes less probable than the best structure once more from inside.
void draw_inside(const Search& search, const EvaluatedHypothesis& best, std::vector<EvaluatedHypothesis>& children);

/// Whether a structure has effects and is more probable than the model without any, these two alone compared: beside a
/// third one that comes nearer it may look so and not be.
bool pays(const Search& search, const EvaluatedHypothesis& one, const std::vector<EvaluatedHypothesis>& pool);

/// Adds a structure, and what it is without any one of its effects if that leaves hardly more: room for others.
void add_with_smaller(const Search& search, const EvaluatedHypothesis& one, std::vector<EvaluatedHypothesis>& beam);

/// Extends the best structures of a pool, as long as that makes the best one better; once more where no first effect
/// does and something is left, and on as long as the closest structure comes much nearer each time: that one is then
/// extended whatever its odds, and without what it holds idle. A step beside effects that takes away little of what is
/// beyond the noise is the last one. What the best one can do without is taken away at once (floating search; P. Pudil,
/// J. Novovicova, J. Kittler, Pattern Recognition Letters 15, 1994). Structures with an effect that does nothing, and
/// those far behind, are not extended, nor is what was before, which `done` keeps, with the same recordings and
/// integration.
void grow(Search& search, std::vector<EvaluatedHypothesis>& pool, std::vector<Hypothesis>& done);

/// A structure without each of its effects in turn, fitted from its parameters on; none for a single effect.
std::vector<EvaluatedHypothesis> smaller(const Search& search, const EvaluatedHypothesis& whole);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/grow.ipp"
#endif
