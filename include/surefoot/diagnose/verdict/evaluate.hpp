// Evaluation on the held-out recordings: errors before and after, against the noise and against a forest in place of
// physics.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/residual_tests/noise_spectrum.hpp"
#include "surefoot/diagnose/verdict/fitted_model.hpp"

namespace surefoot::diagnosis {

struct EvaluationCriteria {
  std::uint32_t rounds = 400;     // of the bootstrap
  std::uint32_t tail = 10;        // rounds beyond each end of its 95 % interval (2.5 %)
  double min_forest_gain = 0.03;  // share of the cross-validated error: as much as an effect must gain
  double min_forest_t = 2.5;      // in standard errors, as for an effect
  std::size_t curves = 8;         // recordings whose curves are kept: more are not looked at
};

/// 95 % interval of the ratio of two root mean square errors, over recordings (bootstrap); `counts`: cells of each.
std::pair<double, double> ratio_interval(const std::vector<double>& before, const std::vector<double>& after,
                                         const std::vector<double>& counts, std::uint64_t seed,
                                         const EvaluationCriteria& criteria = {});

/// Whether a forest beside the effects is worth keeping.
bool forest_helps(const Comparison& cross_validated, double held_out_before, double held_out_after,
                  const EvaluationCriteria& criteria = {});

/// Error of the held-out recordings with what a forest expects of the residuals taken off: one that has not seen them.
double corrected_error(const EstimationSetup& setup, const FittedModel& model, const Parallel& parallel,
                       std::uint64_t seed);

/// A forest beside the effects. `held_out_before`: error of the held-out recordings without it.
ForestResidual offer_forest(const EstimationSetup& setup, const FittedModel& chosen, double held_out_before,
                            const Parallel& parallel, std::uint64_t seed, const EvaluationCriteria& criteria = {});

/// Standard deviation of the noise of one output: as stated; or, where it is not, by the spectrum of residuals, and no
/// less than rounding to the steps of the readings gives; or, where rows are too few for a spectrum, or it looks like a
/// slow error though nothing lasts, the part of the residuals of the median recording that no lag predicts, at least
/// what differs from row to row and at most four times that (an autoregression that keeps 0.9). Never more than the
/// `error` of the model.
double output_noise(const BoundSimulator& bound, const std::vector<std::size_t>& recordings, Eigen::Index output,
                    const WhitenessTest& residuals, const FastSpectrum& spectrum, double error);

std::vector<ChannelMismatch> mismatch_by_output(const EstimationSetup& setup, const FittedModels& models);

/// Error that noise alone leaves, in units of `scale` (by output); NaN if that of any output cannot be told.
double noise_floor(const std::vector<ChannelMismatch>& outputs, const Eigen::VectorXd& scale);

/// Error on held-out recordings, each output in units of what its own noise leaves of it, root mean square over
/// outputs: a coarse sensor does not hide what a fine one shows. NaN if the noise of any output cannot be told.
double noise_ratio(const std::vector<ChannelMismatch>& outputs);

/// Noise that was estimated is no more than the `least` error on held-out recordings that any other structure or a
/// forest left, all outputs in proportion: what these predict is none.
void cap_noise(Diagnosis& diagnosis, double least, const Eigen::VectorXd& scale);

/// Fills in errors and curves.
void evaluate_errors(const EstimationSetup& setup, const FittedModels& models, Diagnosis& diagnosis, std::uint64_t seed,
                     const EvaluationCriteria& criteria = {});

/// Fills in what a forest beside the effects does, of a diagnosis that has its verdict.
void offer_forests(const EstimationSetup& setup, const FittedModels& models, Diagnosis& diagnosis,
                   const Parallel& parallel, std::uint64_t seed, const EvaluationCriteria& criteria = {});

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/evaluate.ipp"
#endif
