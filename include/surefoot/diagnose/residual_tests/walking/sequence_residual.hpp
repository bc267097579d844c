// A test of final poses for unknown physics: whether the errors of sequences can be predicted, on sequences not used,
// from what happened in their steps. The unknown change of each step's displacement is a Gaussian process
// over what it may depend on; carried to the end of the sequence along the simulated path it remains one, so that final
// poses are enough to predict others (Rasmussen & Williams, "Gaussian Processes for Machine Learning", 2006, ch. 2).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/core/pose2.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"

namespace surefoot::diagnosis {

/// What a change of steps may depend on; each has its own kernel.
enum class StepFeature : unsigned char { commands, change_of_commands, heading, place, slip, time, parity, third };
inline constexpr StepFeature step_features[] = {StepFeature::commands, StepFeature::change_of_commands,
                                                StepFeature::heading,  StepFeature::place,
                                                StepFeature::slip,     StepFeature::time,
                                                StepFeature::parity,   StepFeature::third};

/// One step of a sequence: what it may depend on, and how its change moves the final cells.
struct WalkedStep {
  Eigen::VectorXd features;
  Eigen::MatrixXd lever;  // cell x (forward, lateral, turn)
};

/// Typical sizes of what steps are compared by.
struct StepScales {
  Eigen::VectorXd input;             // of each input
  Eigen::Vector3d step = {0, 0, 0};  // of a step forward, to the side and of its turn [m, m, rad]
  double extent = 0;                 // farthest that x or y gets from 0 [m]
};

StepScales step_scales(const BoundSimulator& bound, const Hypothesis& hypothesis,
                       const std::vector<std::size_t>& recordings, const std::vector<SimulatedRun>& runs);

/// Features whose scale is 1: a distance of 1 makes steps unlike each other.
Eigen::VectorXd features_of_step(const BoundSimulator& bound, std::size_t r, const SimulatedRun& run, Eigen::Index step,
                                 StepFeature feature, const StepScales& scales);

/// How a change of the displacement in a step, in the body frame, moves the measured cells of the final pose.
Eigen::MatrixXd lever_of_step(const BoundSimulator& bound, const SimulatedRun& run, const std::vector<Cell>& cells,
                              Eigen::Index step);

/// Simulated displacement of a step, in the body's frame.
Eigen::Vector3d moved_in_step(const PlanarInfo& planar, const SimulatedRun& run, Eigen::Index step);

/// Covariance of whitened final residuals, if every step changes by 5 % of its usual size as the kernel of this feature
/// says. Cost: the square of the number of steps.
Eigen::MatrixXd sequence_covariance(const std::vector<std::vector<WalkedStep>>& sequences,
                                    const Eigen::Vector3d& step_size);

inline constexpr double process_sizes[] = {0.01, 0.1, 1.0, 10.0, 100.0};
inline constexpr double noise_variances[] = {0.01, 0.03, 0.1, 0.3, 1.0};

/// Twice the logarithm of how much likelier residuals are with the process than as noise alone, with the best sizes of
/// both. `turned` are the residuals in the eigenvectors of the covariance, `values` its eigenvalues.
double process_evidence(const Eigen::VectorXd& values, const Eigen::VectorXd& turned);

/// Predicts held-out residuals from the others; the size of the process and of the noise by maximum likelihood.
Eigen::VectorXd predict_held_out(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& residuals,
                                 const std::vector<Eigen::Index>& known, const std::vector<Eigen::Index>& held_out);

inline constexpr int permutations = 400;

/// The evidence for a process with this covariance, first as it is, then with the residuals of whole sequences
/// exchanged at random. Sequences must have equally many residuals; empty if not.
std::vector<double> permuted_evidence(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& residuals,
                                      std::size_t sequences);

/// One of the kernels that are tried.
struct KernelChoice {
  StepFeature feature = StepFeature::commands;
  bool headings_only = false;
};

/// All residuals, sequence by sequence, and what they would have in common with such a kernel.
struct SequenceData {
  std::vector<Eigen::Index> begin;  // by sequence: its first residual; and the end
  Eigen::VectorXd residuals;
  Eigen::MatrixXd covariance;
};

/// The test under way: sequences in the order of the folds, and how the model walks them.
struct SequenceTest {
  const BoundSimulator& bound;
  const FitProblem& problem;
  std::vector<std::size_t> order = {}, fold_of = {};  // recordings, and the fold of each
  std::vector<SimulatedRun> runs = {};
  StepScales scales = {};

  /// False if there is too little to tell.
  bool read_off(const KernelChoice& kernel, SequenceData& data) const;
  Comparison cross_validated(const SequenceData& data) const;
};

/// The comparison of the kernel with the largest evidence, and the p-value of this against the largest evidence that
/// permuted sequences give any kernel.
Comparison most_evident(std::vector<Comparison> found, const std::vector<std::vector<double>>& evidence);

/// The gain on held-out folds of such predictions over none, by the kernel with the most evidence; its p-value is that
/// of a permutation test over all kernels. Both must speak for it before something is held to be missing.
Comparison sequence_structure(const BoundSimulator& bound, const Hypothesis& hypothesis, const FitProblem& problem,
                              const std::vector<std::vector<std::size_t>>& folds, const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/walking/sequence_residual.ipp"
#endif
