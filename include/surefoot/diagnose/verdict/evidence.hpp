// Evidence for a verdict, measured on fitted models.
#pragma once

#include <cstdint>

#include "surefoot/diagnose/verdict/fitted_model.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

/// Marks the held-out recordings of a diagnosis, whose errors are known, that are further off than noise explains.
void mark_beyond_noise(Diagnosis& diagnosis, const VerdictCriteria& verdict);

/// `diagnosis` has its errors already; `calibration` compares the nominal with the calibrated model. Tests that take
/// long are made only while nothing else says that something is left unexplained.
VerdictEvidence gather_evidence(const EstimationSetup& setup, const FittedModels& models, const Diagnosis& diagnosis,
                                const Comparison& calibration, const VerdictCriteria& verdict,
                                const Parallel& parallel, std::uint64_t seed);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/evidence.ipp"
#endif
