// Errors of predictions: how well structures predict recordings that they were not fitted to. Where something is left
// that noise does not explain, every structure is of a wrong form somewhere, and a close fit may come of parameters bent
// to these recordings; what it says of others tells. An error of form is then as large as what the closest prediction
// leaves, or as a diagnosis tolerates anyway.
#pragma once

#include <vector>

#include "surefoot/diagnose/selection/children.hpp"
#include "surefoot/diagnose/selection/ranking.hpp"

namespace surefoot::diagnosis {

/// Errors of each recording by fits to those folds (SearchProblem::folds) that it is not in, its unknown initial states
/// estimated; at least two folds. Cost: a fit for each fold.
ErrorSquares errors_of_predictions(const Search& search, const EvaluatedHypothesis& one);

/// A pool with the root mean square errors of predictions. Where the best structure leaves more than noise: of those
/// that are not `hopeless` behind it (SearchEffort::predicted of them at most) and the model without effects, all
/// measured by their predictions, and no others. Else all, as they are, with the errors of predictions of what cannot
/// be told from the best. The pool as it is where there are no two folds or no time is left.
std::vector<EvaluatedHypothesis> with_predictions(const Search& search, const std::vector<EvaluatedHypothesis>& pool);

/// All structures of a selection with the errors of their fits, those of the pool that it was made from.
void restore_errors_of_fits(Selection& selection, const std::vector<EvaluatedHypothesis>& pool);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/predictions.ipp"
#endif
