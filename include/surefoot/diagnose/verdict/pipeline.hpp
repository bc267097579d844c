// The pipeline: the stages of a diagnosis, one after the other, and again where what was found shows more.
#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "surefoot/diagnose/options.hpp"
#include "surefoot/diagnose/verdict/examine_recordings.hpp"
#include "surefoot/diagnose/verdict/fitted_model.hpp"
#include "surefoot/diagnose/verdict/run_context.hpp"

namespace surefoot::diagnosis {

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
