// Evidence for a verdict, measured on fitted models.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "surefoot/diagnose/verdict/fitted_model.hpp"
#include "surefoot/diagnose/verdict/verdict.hpp"

namespace surefoot::diagnosis {

/// Marks the held-out recordings of a diagnosis, whose errors are known, that are further off than noise explains.
void mark_beyond_noise(Diagnosis& diagnosis, const VerdictCriteria& verdict);

/// VerdictEvidence::process_ratio from the root mean squares of rows' errors by output, where each row is predicted
/// from the readings of the row before.
double process_ratio(const std::vector<OutputInfo>& outputs, const Eigen::VectorXd& residuals);

/// Sets process_ratio and process_rows from runs of the training recordings; nothing for other kinds of noise.
void compare_with_process_noise(const EstimationSetup& setup, const std::vector<SimulatedRun>& training_runs,
                                VerdictEvidence& evidence);

/// `diagnosis` has its errors already; `calibration` compares the nominal with the calibrated model. Tests that take
/// long are made only while nothing else says that something is left unexplained.
VerdictEvidence gather_evidence(const EstimationSetup& setup, const FittedModels& models, const Diagnosis& diagnosis,
                                const Comparison& calibration, const VerdictCriteria& verdict,
                                const Parallel& parallel, std::uint64_t seed);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/evidence.ipp"
#endif
