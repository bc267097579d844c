// Proposals: every effect at every place where it may attach, ranked by how much of the residuals the change of the
// simulation that it causes would explain, apart from what the model's own parameters could do.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"

namespace surefoot::diagnosis {

/// Limits of a linear prediction of what an effect explains.
struct ProposalCriteria {
  double visible_share = 0.05;          // of the residuals' squares, that an effect must take away to be seen
  double negligible_signature = 1e-12;  // of the residuals' squares: rounding, the effect does nothing here
  double ridge = 1e-12;                 // of the signatures' squares: where two strengths do the same
  double resized_from = 0.5;            // residuals over a signature: below, it is tried smaller,
  int resizings = 2;                    // at most so often
  double order_matters = 0.01;          // of the residuals' squares, explained more in front of others: not by rounding
};

/// An effect that is worth a fit, with the parameters to start it from.
struct Proposal {
  AttachedEffect effect;
  std::size_t before = 0;  // the effect of the base that it acts before; their number: after all of them
  Eigen::VectorXd start;
  double gain = 0;                           // share of the squared residuals it would explain
  double distinct = 0;                       // share of its signature that the model's parameters cannot imitate
  Eigen::VectorXd tried;                     // the parameters it was screened with
  std::vector<Eigen::VectorXd> more_starts;  // worse ones; for effects without a strength the order means little
  double visible = 0;                        // multiple of those that could just be seen; 0: none

  // For predictions beside others, by strength (or the one column of an effect without any):
  Eigen::MatrixXd beyond;  // signatures beyond the model's parameters, in units of the root of the open squares
  Eigen::VectorXd along;   // their products with the open residuals, in units of the same
  Eigen::VectorXd least_share, most_share;  // limits of the multiple of `tried`
};

/// Residuals of a fitted hypothesis, and the part of them that its parameters cannot change.
struct OpenResiduals {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd basis;  // of what the parameters can do, orthonormal
  Eigen::VectorXd open;   // beyond it; cut off at the robust limit
  double energy = 0;      // squares of the open ones

  Eigen::VectorXd beyond_parameters(const Eigen::VectorXd& change) const;
};

OpenResiduals open_residuals(const BoundSimulator& bound, const Hypothesis& base, const FitProblem& problem,
                             const Parallel& parallel);

/// Places of the strengths among the parameters of an effect.
std::vector<Eigen::Index> strengths_of(const Effect& effect);

/// The hypothesis with one more effect, in front of the one at `before`.
Hypothesis with_effect(Hypothesis base, const AttachedEffect& effect, const Eigen::VectorXd& values,
                       std::size_t before);

/// Changes of the residuals that an effect with these parameters causes, a column for each of its strengths alone (one
/// column if it has none); empty if the simulation runs away.
Eigen::MatrixXd signatures(const BoundSimulator& bound, const Hypothesis& base, const FitProblem& problem,
                           const Eigen::VectorXd& residuals, const AttachedEffect& candidate,
                           const Eigen::VectorXd& start, std::size_t before);

/// The same values, with each strength that causes more than what is left made smaller: a change of the simulation is in
/// proportion to a strength only near the size in question (a pendulum that has come to rest stays so).
Eigen::VectorXd as_large_as_residuals(const AttachedEffect& candidate, const Eigen::VectorXd& values,
                                      const Eigen::MatrixXd& signatures, const OpenResiduals& open,
                                      const ProposalCriteria& criteria = {});

/// Predicts what an effect would explain; no effect in it if its signatures are empty.
Proposal predict_gain(const BoundSimulator& bound, const OpenResiduals& open, const AttachedEffect& candidate,
                      const Eigen::VectorXd& start, const Eigen::MatrixXd& signatures,
                      const ProposalCriteria& criteria);

/// Ranks candidates, best first. `base` is fitted; only `problem.recordings` are simulated, once per candidate, start
/// and strength, and again where a strength was too large; the further starts of a candidate begin as large as the one
/// before was found to be right. An effect on an input or a sensor that others act on already is tried behind them and
/// in front of them, since order matters (a reading that is rounded and then drifts, or drifts and is then rounded);
/// but not in front of the first `known` effects, those of the model.
std::vector<Proposal> propose(const BoundSimulator& bound, const Hypothesis& base, const FitProblem& problem,
                              const std::vector<AttachedEffect>& candidates, std::size_t known,
                              const Parallel& parallel, const ProposalCriteria& criteria = {});

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/selection/propose.ipp"
#endif
