// A fit of a motion model whose uncertainty is read off how much whole sequences differ: noise of successive cycles
// may be correlated, sequences are independent. The sandwich covariance of clusters with the correction CR2 for few of
// them (Bell and McCaffrey, "Bias reduction in standard errors for linear regression with multi-stage samples", Survey
// Methodology 28, 2002), shrunk towards a multiple of the covariance that independent cycles would give, as far as the
// sequences do not tell more (Ledoit and Wolf, "A well-conditioned estimator for large-dimensional covariance matrices",
// Journal of Multivariate Analysis 88, 2004). Cost: some fits, and parameters^3 per sequence.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// Where parameters lie before sequences are seen.
struct ParameterPrior {
  Eigen::VectorXd mean;
  Eigen::MatrixXd information;  // inverse of their covariance
};

/// A fit, and what each sequence contributes to it. Parameters are counted in widths of their ranges.
struct SequenceFit {
  AnyMotionModel model;
  Eigen::MatrixXd root = {};                 // symmetric; its square is the covariance for independent cycles
  Eigen::MatrixXd prior_share = {};          // how much of that is the prior: from 0, not at all, to 1, all
  std::vector<Eigen::VectorXd> contributions = {};  // by sequence; the sum of their squares is 1 - prior_share if cycles are
                                        // independent with the given noise
  Eigen::VectorXd squares = {}, counts = {};      // by sequence: sum of the squared whitened innovations, and how many there are
  double spent = 0;                     // how many of all of them the parameters took away

  /// Covariance of the parameters, in their units, if whole sequences differ by `inflation`.
  Eigen::MatrixXd covariance(const Eigen::MatrixXd& inflation) const;
};

/// Fits from the mean of the prior on, or from `start`. Throws MotionError if a sequence cannot be used.
SequenceFit fit_sequences(std::span<const WalkSequence> sequences, const AnyMotionModel& start,
                          const MotionNoise& noise, const PoseAccuracy& accuracy, const ParameterPrior& prior);

/// How much more, or less, whole sequences differ than independent cycles would make them: the matrix that is one for
/// independent cycles, from all sequences of all fits.
Eigen::MatrixXd covariance_inflation(std::span<const SequenceFit* const> fits);

namespace detail {

/// f(eigenvalue) in the place of each eigenvalue of a symmetric matrix.
Eigen::MatrixXd map_eigenvalues(const Eigen::MatrixXd& a, const std::function<double(double)>& f);

}  // namespace detail

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/changes/sequence_fit.ipp"
#endif
