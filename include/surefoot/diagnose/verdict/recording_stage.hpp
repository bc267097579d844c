// Recordings made ready for a diagnosis: screened, cut where that helps, and held out in turn.
#pragma once

#include <vector>

#include "surefoot/diagnose/verdict/examine_recordings.hpp"
#include "surefoot/diagnose/verdict/fitted_model.hpp"

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

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/recording_stage.ipp"
#endif
