// Fit of the parameters of a hypothesis to recordings: Gauss-Newton in the simulation loop, with bounds and a robust
// loss. Cost of an iteration: (model parameters + effect parameters + free states of one recording + 1) simulations of
// all recordings.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/prior.hpp"
#include "surefoot/diagnose/estimation/residuals.hpp"
#include "surefoot/optimize/least_squares.hpp"

namespace surefoot::diagnosis {

/// The recordings of a fit and how it counts.
struct FitProblem {
  std::vector<std::size_t> recordings;
  Weighting weighting;
  Integration integration;
  Free free = Free::everything;
  int max_iterations = 18;
  int secant_steps = 3;                                  // as in LeastSquaresOptions: a Jacobian costs many simulations
  double tolerance = 1e-4;                               // relative decrease of the loss at which it ends
  Eigen::VectorXd prior = {};                            // parameters of the model to stay near to (prior.hpp), if any
  double reach = 0;                                      // loss that it must come near, to go on (comes_nearer)
  std::function<bool()> stopped = [] { return false; };  // asked before each iteration
};

/// The same, anywhere within the bounds.
FitProblem without_prior(FitProblem problem);

/// Of the loss of another fit: less of a difference is one of where iterations ended.
inline constexpr double clearly_less = 0.98;

struct Fit {
  Hypothesis hypothesis;
  double loss = std::numeric_limits<double>::infinity();  // mean of the robust squared residuals
  bool ok = false;
};

/// Whether a few iterations came near enough to a loss that is to be reached: a tenth of the way to it, in logarithms.
bool comes_nearer(double before, double now, double reach);

/// Everything on this thread.
Parallel serially();

/// Weighted residuals and their derivatives as functions of the searched variables.
class FitFunctions {
 public:
  FitFunctions(const BoundSimulator& bound, const Hypothesis& start, const FitProblem& problem,
               const Parallel& parallel);

  const std::vector<Variable>& variables() const { return variables_; }
  /// Where the residuals of each recording begin, and their end.
  const std::vector<Eigen::Index>& begin() const { return begin_; }

  Eigen::VectorXd start() const;
  Box<Eigen::Dynamic> box() const;
  Hypothesis at(const Eigen::VectorXd& z) const;
  /// Of all recordings and, behind them, of the problem's prior.
  Eigen::VectorXd residuals(const Eigen::VectorXd& z) const;

  /// Forward differences from z, where the residuals are `here`. A free initial state moves the residuals of its own
  /// recording only. Where a sensor rounds, those of what it reads before: what is inside of a step would tell no fit
  /// which way to go. (Differences of the steps themselves are of the readings.)
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& z, const Eigen::VectorXd& here) const {
    return differences(z, here, false);
  }

  /// The same by differences to both sides, at twice the cost: so that what parameters do only together cancels out.
  Eigen::MatrixXd central_jacobian(const Eigen::VectorXd& z, const Eigen::VectorXd& here) const {
    return differences(z, here, true);
  }

 private:
  Eigen::MatrixXd differences(const Eigen::VectorXd& z, const Eigen::VectorXd& here, bool central) const;

  Eigen::VectorXd residuals_at(const Hypothesis& hypothesis) const;
  Eigen::VectorXd residuals_of(const Hypothesis& hypothesis, std::size_t i) const;  // of one recording

  const BoundSimulator& bound_;
  Hypothesis base_;
  const FitProblem& problem_;
  Parallel parallel_;  // a copy: callers hand in temporaries
  std::vector<Variable> variables_;
  std::size_t shared_ = 0;  // variables that all recordings depend on: the first ones
  std::vector<std::vector<Cell>> cells_;
  std::vector<Eigen::Index> begin_;
  PriorRows prior_;
};

/// Whether any of these recordings has an initial state to be estimated.
inline bool has_unknown_initial_state(const BoundSimulator& bound, const std::vector<std::size_t>& recordings) {
  return holds_for_any(recordings, [&](std::size_t r) { return has_unknown_initial_state(bound.recordings[r]); });
}

/// Mean robust squared residual.
double mean_loss(const Eigen::VectorXd& residuals, double robust);

/// The same of a hypothesis as it is, whatever its fit would change; NaN where its simulation runs away.
double loss_of(const BoundSimulator& bound, const Hypothesis& hypothesis, const FitProblem& problem,
               const Parallel& parallel);

/// Fits a hypothesis, from its own parameters on. Never worse than the start. An initial state that has strayed into
/// another valley, such as an angle a whole turn away, is read off its recording again.
/// Where an effect may begin unsettled and was left settled, its beginning is sought all over its range, by recording.
Fit fit(const BoundSimulator& bound, const Hypothesis& start, const FitProblem& problem, const Parallel& parallel);

/// The same for each hypothesis, one beside the other. Those that come after the problem is stopped stay as they are.
void fit_each(const BoundSimulator& bound, std::vector<Fit>& fits, const FitProblem& problem, const Parallel& parallel);

/// A hypothesis with the unknown initial states of some recordings estimated, and all else as it is.
Hypothesis with_estimated_initial_states(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                         const std::vector<std::size_t>& recordings, FitProblem problem,
                                         const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/fit.ipp"
#endif
