// Forms of an effect beside the one that was found, tried from its fit: those that extend it, those it extends, any
// others.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "surefoot/diagnose/selection/children.hpp"

namespace surefoot::diagnosis {

/// What a richer form must take away: while structures are sought, more than an error of form, since it would take the
/// place of effects that are not found yet; in the best of them, anything that recordings show.
enum class ErrorsOfForm { tolerated, counted };

/// A structure with its effects, one after the other, in a form that extends theirs (Effect::extends) where recordings
/// show it to be better at the odds that name an effect; none where nothing is. A form that adds what moves by itself
/// bends to anything that is not understood: it must leave no more than noise. Cost: by such form a fit of where
/// recordings begin, if it has that free, a few iterations if that helps, and a whole fit if these do.
/// `reach`: a loss that these iterations must come nearer to.
std::optional<EvaluatedHypothesis> in_richer_forms(const Search& search, const EvaluatedHypothesis& found,
                                                   ErrorsOfForm errors_of_form,
                                                   double reach = std::numeric_limits<double>::infinity());

/// A structure with its effect number `e` in its other forms that extend none, all else as it was found: the best
/// `keep`, fitted and evaluated. `finely`: each with steps as fine as it needs where it begins, for a form that is
/// stiffer than the one that was found would end where coarse steps do not run away.
std::vector<EvaluatedHypothesis> in_other_forms(const Search& search, const EvaluatedHypothesis& found, std::size_t e,
                                                std::size_t keep, bool finely);

/// The parameters of an effect that another one comes to without some of its own, from the values that it was found
/// with: it may be confused with it at the same place, and has all of its parameters by name, such as an elastic joint
/// of backlash whose gap has closed. Empty if it is none.
Eigen::VectorXd values_of_special_case(const AttachedEffect& special, const AttachedEffect& whole,
                                       const Eigen::VectorXd& values);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/richer_forms.ipp"
#endif
