// The search as a stage of the diagnosis: its subject, and what follows where it finds inputs or initial states
// otherwise.
#pragma once

#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/selection/search.hpp"
#include "surefoot/diagnose/verdict/calibrate_model.hpp"

namespace surefoot::diagnosis {

/// Effects that may be missing, at the places where they may be.
std::vector<AttachedEffect> candidate_effects(const EstimationSetup& setup, const Calibration& calibration,
                                              const RunContext& run);

/// The subject of the search. It keeps a reference to the setup.
SearchProblem search_problem(const EstimationSetup& setup, const Calibration& calibration, const RunContext& run);

/// A search and what led to it.
struct Searched {
  Calibration calibration;
  SearchProblem problem;
  std::vector<AttachedEffect> candidates;
  Selection selection;
};

/// Calibrates and searches, also from what was found before.
Searched search_effects(EstimationSetup& setup, const RunContext& run, Diagnosis& diagnosis,
                        const std::vector<Hypothesis>& begun = {});

/// Fits the model without effects once more where the search found inputs to be otherwise than it began with.
void take_over_inputs(EstimationSetup& setup, Searched& found, const RunContext& run);

/// With what was found recordings may refute more initial states, which asks for another search, or those freed before
/// may be known after all.
void revise_initial_states(EstimationSetup& setup, Searched& found, const RunContext& run, Diagnosis& diagnosis);

/// Takes out single readings that are far from a model while their neighbours are not: no physics lasts for one row.
void remove_outliers_from(EstimationSetup& setup, const Hypothesis& model, const RunContext& run, Diagnosis& diagnosis);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/search_stage.ipp"
#endif
