// One step of the search: a structure with a further effect, or with a pair where no single one is worth its
// parameters. Weights follow what the best one so far leaves.
#pragma once

#include <limits>
#include <vector>

#include "surefoot/diagnose/selection/children.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/explains.hpp"
#include "surefoot/diagnose/selection/richer_forms.hpp"

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

/// Chooses anew how coarse the steps may be while fits are only compared, by what their parent leaves.
void choose_screening(Search& search, const EvaluatedHypothesis& parent);

/// A hypothesis, fitted and evaluated again.
EvaluatedHypothesis refitted(const Search& search, const Hypothesis& one);

/// Richer forms for the best structures, none of them `hopeless` behind the best [nat]; `reach` as of in_richer_forms.
void enrich(const Search& search, std::vector<EvaluatedHypothesis>& pool, double hopeless, ErrorsOfForm errors_of_form,
            double reach = std::numeric_limits<double>::infinity());

/// The best structures, and the model without effects, fitted and evaluated with the present weights and recordings.
std::vector<EvaluatedHypothesis> fitted_again(const Search& search, const std::vector<EvaluatedHypothesis>& pool);

/// Fits the best of a pool from places around, with a growing horizon and under guidance, where they leave more than
/// noise: another effect would only mend a fit that ended in a valley.
void try_around(const Search& search, std::vector<EvaluatedHypothesis>& pool);

/// Whether the best of first effects, in a richer form and with the steps that it needs, leaves no more than noise:
/// what coarse steps or a plain form leave would pass for a second effect. The search goes on with these steps then,
/// and with all of these children fitted so.
bool settle_alone(Search& search, std::vector<EvaluatedHypothesis>& children);

/// Fits first effects once more with the model's parameters from many places: what is missing may have pushed the
/// calibrated ones where no fit finds back from.
void fit_from_everywhere(const Search& search, std::vector<EvaluatedHypothesis>& children);

/// The children of one parent into the pool of children; no fits for what cannot come near the best structure so far.
void extend(Search& search, const EvaluatedHypothesis& parent, const EvaluatedHypothesis& best,
            std::vector<EvaluatedHypothesis>& children);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/extend.ipp"
#endif
