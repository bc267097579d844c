// Sparse changes between two calibrations of many coefficients: the posterior probability of every small set of changes,
// given the difference of the coefficients and how well it is known. Half of the prior is for no change; sets of k
// changes share 1 / 2^(k+1), each by the product of the weights of its changes. What a set predicts of the difference is
// its marginal likelihood (spike and slab: Mitchell and Beauchamp, "Bayesian variable selection in linear regression",
// Journal of the American Statistical Association 83, 1988); the difference is Student's, since its covariance comes
// from a limited number of sequences. Sets are searched from small to large, the best of each size being enlarged. Cost:
// size^3 per set, some ten thousand sets.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"

namespace surefoot {

/// One thing that can change.
struct WalkChange {
  std::string name;
  Eigen::VectorXd direction = {};  // by coefficient, for a change of size 1; empty: not a change of coefficients
  double deviation = 0;            // standard deviation of the size, before anything is known
  double weight = 1;               // how likely it is beside the others, before anything is known
  double log_bayes_factor = 0;     // of changes that are not of coefficients: of a change against none [nats]
};

/// The evidence about the coefficients when the response comes later by so many cycles.
struct DifferenceEvidence {
  int delay = 0;                // [cycles]
  Eigen::VectorXd difference = {};   // of the coefficients, new minus old
  Eigen::MatrixXd information = {};  // inverse of its covariance
  double freedoms = 0;          // degrees of freedom that the covariance was estimated with
  double log_evidence = 0;      // of the data if no coefficient changed, up to a constant that is the same for all [nats]
};

struct SparseChangeOptions {
  double nothing = 0.5;       // prior probability that nothing changed
  double delay_weight = 1;    // of a delay beside the changes
  int largest_set = 10;       // sets of more changes are not looked at: the walk as a whole is another one then
  int enlarged = 100;         // best sets of each size that are enlarged; all pairs of 14 changes
  double negligible = 1e-5;   // a size whose sets have less than this posterior probability ends the search
};

/// Throws MotionError, naming the field.
void check(const SparseChangeOptions& options);

/// A set of changes.
struct ChangeSet {
  int delay = 0;             // [cycles] later
  std::vector<int> members = {};  // indices of the changes, rising
  double probability = 0;    // posterior
};

struct ChangePosterior {
  std::vector<ChangeSet> sets;   // the likeliest first
  Eigen::VectorXd inclusion;     // by change: the probability that it is among those that happened
  double nothing = 0;            // the probability that nothing changed

  /// The probability that at least one of these happened; an index of -1 is a delay.
  double any_of(std::span<const int> changes) const;
};

/// `by_delay` starts with no delay.
ChangePosterior posterior_of_changes(std::span<const DifferenceEvidence> by_delay, std::span<const WalkChange> changes,
                                     const SparseChangeOptions& options = {});

/// Sizes of the changes of coefficients in a set, if it is they that happened, and their standard errors.
struct ChangeSizes {
  Eigen::VectorXd size, standard_error;  // by member of the set; 0 for members that are not of coefficients
};

ChangeSizes change_sizes(const DifferenceEvidence& evidence, std::span<const WalkChange> changes,
                         std::span<const int> members);

/// The smallest change of that kind that would be found, alone, with `certainty` in 95 of 100 comparisons like this one;
/// infinite if none would.
double smallest_detectable(const DifferenceEvidence& evidence, std::span<const WalkChange> changes, int change,
                           double certainty, const SparseChangeOptions& options = {});

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/changes/sparse_changes.ipp"
#endif
