// Evidence for a verdict, measured on fitted models.
#pragma once

#include <cstdint>

#include "surefoot/diagnose/verdict/fitted_model.hpp"
#include "surefoot/diagnose/verdict/held_out_check.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

/// `calibration` compares the nominal with the calibrated model. Tests that take long are made only while nothing else
/// says that something is left unexplained.
VerdictEvidence gather_evidence(const EstimationSetup& setup, const FittedModels& models, const Comparison& calibration,
                                const VerdictCriteria& verdict, const Parallel& parallel, std::uint64_t seed);

/// Adds what the errors of the held-out recordings say against the noise, to the evidence and to the diagnosis.
void add_errors(const EstimationSetup& setup, Diagnosis& diagnosis, const VerdictCriteria& verdict,
                VerdictEvidence& evidence);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/evidence.ipp"
#endif
