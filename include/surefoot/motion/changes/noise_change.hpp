// Evidence that something else than the mean of a walk changed: its noise, and how often it falls.
#pragma once

#include <Eigen/Core>
#include <span>

#include "surefoot/core/compiled.hpp"

namespace surefoot {

/// A variance that was estimated with so many degrees of freedom.
struct VarianceEstimate {
  double variance = 0;
  double freedoms = 0;
};

/// The variance of values of which each is the mean of squares of one sequence. Degrees of freedom are what the values
/// really differ by (Welch and Satterthwaite), since noise of successive cycles may be correlated and its tails heavy;
/// with few sequences they are drawn towards `usual`, those of one sequence.
VarianceEstimate pooled_variance(const Eigen::VectorXd& mean_squares, double usual);

/// What two variances say about their ratio.
struct VarianceChange {
  double ratio = 1;              // new over old
  double low = 0, high = 0;      // 95 % interval of the ratio
  double log_bayes_factor = 0;   // of a change against none [nats]
  double log_likelihood_ratio = 0;  // of the likeliest ratio against 1 [nats]
};

/// The ratio of two estimates is distributed as F times the true one, whose logarithm has the standard deviation
/// `deviation` about 0 if the noise changed.
VarianceChange variance_change(const VarianceEstimate& before, const VarianceEstimate& after, double deviation);

/// How many of some sequences fell.
struct FallCount {
  int fell = 0, sequences = 0;
};

struct FallChange {
  double p_value = 1;           // of Fisher's exact test, two-sided
  double log_bayes_factor = 0;  // of two rates against one, each uniform between 0 and 1 [nats]
};

FallChange fall_change(const FallCount& before, const FallCount& after);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/changes/noise_change.ipp"
#endif
