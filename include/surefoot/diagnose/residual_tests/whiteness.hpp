// Test for anything that is left: residuals of a good model are noise, which forgets itself within a few rows; what a
// model leaves out does not.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"

namespace surefoot::diagnosis {

/// How much of the residuals of one output is not noise.
struct WhitenessTest {
  double share = 0;       // of the mean square that is still correlated after the noise has forgotten itself
  double predicted = 0;   // share of it that residuals from before then predict: slow errors, oscillations
  double p_value = 1;     // one-sided, that there is none
  double rms = 0;         // of the residuals, in the unit of the output
  double typical = 0;     // the same of the median recording: what is off in a few is not everywhere
};

/// Residuals of one output in one recording; what was not measured is 0.
Eigen::VectorXd series_of(const BoundSimulator& bound, std::size_t r, const SimulatedRun& trajectory,
                          Eigen::Index output);

/// Sums of products of neighbours `lag` rows apart, by lag, over all series.
Eigen::VectorXd lagged_products(const std::vector<Eigen::VectorXd>& series, Eigen::Index from, Eigen::Index to);

/// Share of the mean square of residuals that a linear prediction explains (Yule and Walker's equations) which knows
/// them up to `gap` rows before. Never below 0; noise that forgets itself within the gap is not predicted. `series`
/// without NaN. Cost: rows * 5 gap + gap^3.
double predicted_share(const std::vector<Eigen::VectorXd>& series, Eigen::Index gap);

/// Upper tail of a sum of squares with this mean and variance, as a scaled chi-square (Wilson & Hilferty 1931).
double chi_square_tail(double value, double mean, double variance);

/// The same value as a standard normal one.
double chi_square_score(double value, double mean, double variance);

/// Squared correlations of residuals over all lags of `from` to `to` rows (a portmanteau, after Box & Pierce 1970), so
/// that slow errors and oscillations count alike. What noise alone would give is found by turning the signs of chunks
/// of `from` rows at random, which keeps noise as it is if it forgets itself within that many. Single outliers are
/// cut off. Cost: 40 * rows * lags.
WhitenessTest test_whiteness(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                             const std::vector<SimulatedRun>& trajectories, Eigen::Index output, Eigen::Index from,
                             Eigen::Index to);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/whiteness.ipp"
#endif
