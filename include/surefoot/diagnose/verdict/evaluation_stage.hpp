// Evaluation of what a search found: the check on held-out recordings, the verdict, and all that is said about it.
#pragma once

#include <vector>

#include "surefoot/diagnose/verdict/fitted_model.hpp"
#include "surefoot/diagnose/verdict/search_stage.hpp"

namespace surefoot::diagnosis {

/// From the search to the finished diagnosis: the final check on held-out recordings, the verdict and everything that
/// is said about it.
void evaluate_selection(const EstimationSetup& setup, const Calibration& calibration, const SearchProblem& problem,
                        const Selection& selection, const std::vector<AttachedEffect>& candidates,
                        const RunContext& run, Diagnosis& diagnosis);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/evaluation_stage.ipp"
#endif
