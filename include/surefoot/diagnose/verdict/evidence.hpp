// Evidence for a verdict, measured on fitted models.
#pragma once

#include <cstdint>
#include <vector>

#include "surefoot/diagnose/verdict/fitted_model.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

/// Marks the held-out recordings of a diagnosis, whose errors are known, that are further off than noise explains.
void mark_beyond_noise(Diagnosis& diagnosis, const VerdictCriteria& verdict);

/// A lower bound of the mean square of errors, so many standard deviations below what was found, from the sum of
/// squares and the number of errors of each recording. Recordings differ by more than these numbers let expect, since
/// errors of a recording go together.
double lower_mean_square(const std::vector<double>& squares, const std::vector<double>& counts, double deviations);

/// VerdictEvidence::process_ratio from runs of the training recordings, each row predicted from the readings before.
double process_ratio(const EstimationSetup& setup, const std::vector<SimulatedRun>& training_runs,
                     const VerdictCriteria& criteria);

/// `diagnosis` has its errors already; `calibration` compares the nominal with the calibrated model. Tests that take
/// long are made only while nothing else says that something is left unexplained.
VerdictEvidence gather_evidence(const EstimationSetup& setup, const FittedModels& models, const Diagnosis& diagnosis,
                                const Comparison& calibration, const VerdictCriteria& verdict,
                                const Parallel& parallel, std::uint64_t seed);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/evidence.ipp"
#endif
