// The pipeline: the stages of a diagnosis, one after the other.
#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "surefoot/diagnose/options.hpp"
#include "surefoot/diagnose/verdict/alternatives.hpp"
#include "surefoot/diagnose/verdict/examine_recordings.hpp"
#include "surefoot/diagnose/verdict/fitted_model.hpp"
#include "surefoot/diagnose/verdict/held_out_check.hpp"
#include "surefoot/diagnose/verdict/run_context.hpp"
#include "surefoot/diagnose/verdict/search_stage.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

/// Checks recordings, takes outliers out of them and says in remarks what cannot be seen in them. Throws DiagnoseError
/// if one does not fit the simulator.
std::vector<Remark> screen_recordings(const SimulatorInfo& info, std::vector<Recording>& recordings);

/// Few recordings are cut into parts, unless those to hold out are named.
std::vector<Recording> cut_few_recordings(const BindSimulator& bind, std::vector<Recording> recordings,
                                          const RunContext& run);

/// Recordings in which differences smaller than the noise decide what comes later are cut there, and remarked on,
/// unless those to hold out are named. By the model with what was found, if that is not null.
std::vector<Recording> cut_sensitive_recordings(const BindSimulator& bind, std::vector<Recording> recordings,
                                                const RunContext& run, std::vector<Remark>& remarks,
                                                const FoundModel* found = nullptr);

/// Holds recordings out, or each in turn.
EstimationSetup hold_out_recordings(const BindSimulator& bind, std::vector<Recording> recordings,
                                    const RunContext& run);

/// Fills in which recordings are for what.
void name_recordings(const EstimationSetup& setup, Diagnosis& diagnosis);

/// Fills in parameters, effects and their evidence.
void describe_models(const EstimationSetup& setup, const FittedModels& models, const Selection& selection,
                     const RunContext& run, Diagnosis& diagnosis);

/// Fills in what might have been chosen instead, and how to tell it apart; returns the names of what cannot be told
/// apart from the choice.
std::vector<std::string> describe_alternatives(const Selection& selection, Diagnosis& diagnosis);

/// Fills in the smallest effects that would have been found, where nothing is missing.
void describe_limits(const EstimationSetup& setup, const FittedModels& models, const SearchProblem& problem,
                     const std::vector<AttachedEffect>& candidates, const RunContext& run, Diagnosis& diagnosis);

/// From the search to the finished diagnosis: the final check on held-out recordings, the verdict and everything that
/// is said about it.
void evaluate_selection(const EstimationSetup& setup, const Calibration& calibration, const SearchProblem& problem,
                        const Selection& selection, const std::vector<AttachedEffect>& candidates,
                        const RunContext& run, Diagnosis& diagnosis);

/// Fits what was chosen by a search that ran out of time to its end, as far as there is time: its fit may have been cut
/// short.
void finish_fit(const EstimationSetup& setup, Hypothesis& chosen, const RunContext& run);

/// All stages after the recordings were screened and examined, from `begun` on if that is not null: fills in the
/// diagnosis.
FoundModel diagnose_recordings(const BindSimulator& bind, std::vector<Recording> recordings, const RunContext& run,
                               Diagnosis& diagnosis, const FoundModel* begun = nullptr);

/// Runs all stages. The result does not depend on how `parallel` shares out the work.
Diagnosis run_pipeline(const BindSimulator& bind, const SimulatorInfo& info, std::vector<Recording> recordings,
                       const DiagnoseOptions& options, const Parallel& parallel, std::uint64_t seed,
                       std::stop_token stop);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/pipeline.ipp"
#endif
