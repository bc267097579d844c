// Noise of an output: white and of constant size, growing with speed, correlated from row to row. The
// likelihood decides, on recordings not used for the fit; an error in the mean cannot show it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/residual_tests/noise_model.hpp"
#include "surefoot/diagnose/text.hpp"

namespace surefoot::diagnosis {

/// When to speak of more than white noise.
struct NoiseCriteria {
  double gain = 0.01;            // least gain in log-likelihood [nat per sample]
  double p_value = 1e-3;         // largest, over held-out blocks
  double rows = 8;               // what is correlated for longer is no noise but missing physics (see detect.hpp)
  double rows_beside_white = 4;  // the same where only a part is correlated: noise, and the rest of a model error
};

inline NoiseSeries part_of(const NoiseSeries& whole, Eigen::Index from, Eigen::Index length) {
  const auto part = [&](const Eigen::VectorXd& all) {
    Eigen::VectorXd some(length);
    std::copy_n(all.data() + from, length, some.data());
    return some;
  };
  return {part(whole.time), part(whole.value), part(whole.speed)};
}

/// Few series are cut, so that some can be held out.
std::vector<NoiseSeries> noise_parts(const std::vector<NoiseSeries>& series, std::size_t wanted);

/// Log-likelihood of held-out blocks, each by a fit to the other folds, close to that to all; and how many samples.
std::pair<std::vector<double>, double> heldout_likelihood(const std::vector<NoiseSeries>& parts, const NoiseFit& all);

struct NoiseEvidence {
  double gain = 0, p_value = 1;
};

/// Evidence for `with` against `without`, both fitted to all parts, in pairs over held-out blocks.
NoiseEvidence noise_evidence(const std::vector<NoiseSeries>& parts, const NoiseFit& with, const NoiseFit& without);

/// `white`, or a fit with a memory that explains all series better, by the Bayesian information criterion.
NoiseFit best_memory(const std::vector<NoiseSeries>& series, const NoiseFit& white);

/// Typical interval between samples.
inline double row_interval(const std::vector<NoiseSeries>& series) { return NoiseCoordinates({}, series).row(); }

double typical_speed(const std::vector<NoiseSeries>& series);

/// Finds what the noise of one output is like from its residuals. `tests`: how many outputs are asked about. Not for
/// residuals that hold missing physics, which looks like either.
std::vector<NoiseFinding> find_noise(const std::vector<NoiseSeries>& series, const OutputInfo& output,
                                     SimulatorKind kind, std::size_t tests = 1, const NoiseCriteria& criteria = {});

/// Residuals of one output about their mean, with its simulated speed; without samples beyond six times `size`.
NoiseSeries noise_series(const BoundSimulator& bound, std::size_t r, const SimulatedRun& run, Eigen::Index output,
                         double size, bool stepwise);

/// Share of neighbouring readings that are equal: above 0.4 the steps of the reading hide what the noise is like.
double equal_readings(const BoundSimulator& bound, const std::vector<std::size_t>& recordings, Eigen::Index output);

/// What the noise of each output is like, from what a hypothesis that leaves nothing unexplained leaves of the
/// recordings. Where noise accumulates the errors of single steps are judged; final poses are too few to tell.
std::vector<NoiseFinding> find_noise(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                     const std::vector<std::size_t>& recordings, NoiseKind noise,
                                     const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/noise.ipp"
#endif
