// First effects of a model without any: found from the calibrated parameters, along the readings and from the nominal
// ones, and settled each with the form, the inputs between rows and the steps of the integration that it needs.
#pragma once

#include <vector>

#include "surefoot/diagnose/selection/children.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"

namespace surefoot::diagnosis {

/// The children of the model without effects, but with the parameters and initial states of `start`: what is missing
/// may have pushed the calibrated ones where no fit finds back from, and where signatures look otherwise. With a `best`
/// structure so far, only what could come near it.
std::vector<EvaluatedHypothesis> extended_from(Search search, Hypothesis start, const EvaluatedHypothesis* best);

/// The same under guidance (guided_fit.hpp): signatures and first fits along the readings, wherever the calibrated
/// model has run to, and at the end fits of whole recordings. Steps, and ways of inputs between rows, that make an
/// effect settle alone stay with the search.
std::vector<EvaluatedHypothesis> extended_under_guidance(Search& search);

/// Whether simulations are so far from the readings, by more than 0.3 of what these deviate from their mean, that what
/// effects add there says little of what is missing.
bool has_lost_readings(const EvaluatedHypothesis& one);

/// Where first effects leave more than noise: the best from places around, first effects under guidance, unless they
/// come from there, and from the nominal parameters on, and pairs of the best. The search goes on with the steps, and
/// ways of inputs between rows, that the best was fitted with, where it runs away without them: steps that were fine
/// enough for the calibration of a stiff machine may be too long for it.
void begin_elsewhere(Search& search, bool guided, std::vector<EvaluatedHypothesis>& children);

/// First effects of the model without any: along the readings first where it has lost them, and elsewhere, too, unless
/// the rival explanation of the problem does better.
std::vector<EvaluatedHypothesis> first_effects(Search& search, const EvaluatedHypothesis& none);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/first_effects.ipp"
#endif
