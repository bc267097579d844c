// Forms of an effect of which others are special cases: they are tried where one of these was found, from its fit.
#pragma once

#include <optional>

#include "surefoot/diagnose/selection/children.hpp"

namespace surefoot::diagnosis {

/// A structure with its effects, one after the other, in a form that extends theirs (Effect::extends) where recordings
/// show it to be better at the odds that name an effect; none where nothing is. Cost: by such form a fit of where
/// recordings begin, if it has that free, and a whole one if that helps.
std::optional<EvaluatedHypothesis> in_richer_forms(const Search& search, const EvaluatedHypothesis& found);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/richer_forms.ipp"
#endif
