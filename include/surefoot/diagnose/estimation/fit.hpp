// Fits the numbers of a hypothesis to recordings: Gauss-Newton in the simulation loop, with bounds and a robust loss.
// Cost of an iteration: (parameters + effect parameters + free states of one recording + 1) simulations of all
// recordings.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "surefoot/diagnose/estimation/residuals.hpp"
#include "surefoot/optimize/least_squares.hpp"

namespace surefoot::diagnosis {

/// The recordings of a fit and how it counts.
struct FitProblem {
  std::vector<std::size_t> recordings;
  Weighting weighting;
  Integration integration;
  Free free = Free::everything;
  int max_iterations = 12;
  double tolerance = 1e-4;  // relative decrease of the loss at which it ends
};

struct Fit {
  Hypothesis hypothesis;
  double loss = std::numeric_limits<double>::infinity();  // mean of the robust squared residuals
  bool ok = false;
};

/// Everything on this thread.
Parallel serially();

/// Residuals and their derivatives as functions of the searched variables.
class FitFunctions {
 public:
  FitFunctions(const BoundSimulator& bound, const Hypothesis& start, const FitProblem& problem,
               const Parallel& parallel)
      : rig_(bound), base_(start), problem_(problem), parallel_(parallel) {
    variables_ = variables_of(bound, start, problem.recordings, problem.free);
    shared_ = static_cast<std::size_t>(std::count_if(
        variables_.begin(), variables_.end(), [](const Variable& v) { return v.kind != Variable::Kind::initial; }));
    begin_.push_back(0);
    for (const std::size_t r : problem.recordings) {
      cells_.push_back(cells_of(bound.recordings[r]));
      begin_.push_back(begin_.back() + static_cast<Eigen::Index>(cells_.back().size()));
    }
  }

  const std::vector<Variable>& variables() const { return variables_; }
  const std::vector<Eigen::Index>& begin() const { return begin_; }

  Eigen::VectorXd start() const {
    Eigen::VectorXd z(static_cast<Eigen::Index>(variables_.size()));
    Hypothesis copy = base_;
    for (std::size_t i = 0; i < variables_.size(); ++i) {
      z[static_cast<Eigen::Index>(i)] =
          to_search(variables_[i], std::clamp(value_of(copy, variables_[i]), variables_[i].low, variables_[i].high));
    }
    return z;
  }

  Box<Eigen::Dynamic> box() const {
    Eigen::VectorXd low(static_cast<Eigen::Index>(variables_.size())), high = low;
    for (std::size_t i = 0; i < variables_.size(); ++i) {
      low[static_cast<Eigen::Index>(i)] = to_search(variables_[i], variables_[i].low);
      high[static_cast<Eigen::Index>(i)] = to_search(variables_[i], variables_[i].high);
    }
    return {low, high};
  }

  Hypothesis at(const Eigen::VectorXd& z) const {
    Hypothesis hypothesis = base_;
    for (std::size_t i = 0; i < variables_.size(); ++i) {
      value_of(hypothesis, variables_[i]) = from_search(variables_[i], z[static_cast<Eigen::Index>(i)]);
    }
    return hypothesis;
  }

  Eigen::VectorXd residuals(const Eigen::VectorXd& z) const {
    const Hypothesis hypothesis = at(z);
    Eigen::VectorXd all(begin_.back());
    parallel_(cells_.size(),
              [&](std::size_t i) { all.segment(begin_[i], begin_[i + 1] - begin_[i]) = one(hypothesis, i); });
    return all;
  }

  /// Forward differences from z, where the residuals are `here`. A free initial state moves the residuals of its own
  /// recording only.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& z, const Eigen::VectorXd& here) const {
    const auto columns = static_cast<Eigen::Index>(variables_.size());
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(begin_.back(), columns);
    std::vector<std::pair<std::size_t, std::size_t>> jobs;  // variable, place of a recording
    for (std::size_t v = 0; v < variables_.size(); ++v) {
      for (std::size_t i = 0; i < cells_.size(); ++i) {
        if (v < shared_ || variables_[v].item == problem_.recordings[i]) jobs.emplace_back(v, i);
      }
    }
    parallel_(jobs.size(), [&](std::size_t j) {
      const auto [v, i] = jobs[j];
      const auto k = static_cast<Eigen::Index>(v);
      const double high = to_search(variables_[v], variables_[v].high);
      const double step = z[k] + 2e-4 > high ? -1e-4 : 1e-4;
      Eigen::VectorXd moved = z;
      moved[k] += step;
      const Eigen::Index length = begin_[i + 1] - begin_[i];
      slopes.col(k).segment(begin_[i], length) = (one(at(moved), i) - here.segment(begin_[i], length)) / step;
    });
    for (Eigen::Index i = 0; i < slopes.size(); ++i) {
      if (!std::isfinite(slopes.data()[i])) slopes.data()[i] = 0;
    }
    return slopes;
  }

 private:
  Eigen::VectorXd one(const Hypothesis& hypothesis, std::size_t i) const {
    const std::size_t r = problem_.recordings[i];
    return weighed_residuals(rig_, r, simulate(rig_, hypothesis, r, problem_.integration), cells_[i],
                             problem_.weighting);
  }

  const BoundSimulator& rig_;
  Hypothesis base_;
  const FitProblem& problem_;
  Parallel parallel_;  // a copy: callers hand in temporaries
  std::vector<Variable> variables_;
  std::size_t shared_ = 0;
  std::vector<std::vector<Cell>> cells_;
  std::vector<Eigen::Index> begin_;
};

/// Whether any of these recordings has an initial state to be estimated.
inline bool free_start(const BoundSimulator& bound, const std::vector<std::size_t>& recordings) {
  return std::any_of(recordings.begin(), recordings.end(),
                     [&](std::size_t r) { return (bound.recordings[r].initial_scale.array() > 0).any(); });
}

/// Mean robust squared residual.
double mean_loss(const Eigen::VectorXd& residuals, double robust);

/// Fits a hypothesis, from its own numbers on. Never worse than the start.
Fit fit(const BoundSimulator& bound, const Hypothesis& start, const FitProblem& problem, const Parallel& parallel);

/// A hypothesis with the unknown initial states of some recordings estimated, and all else as it is.
Hypothesis with_estimated_starts(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                 const std::vector<std::size_t>& recordings, FitProblem problem,
                                 const Parallel& parallel);

/// Standard errors of the fitted numbers that hold for residuals that are not independent: the covariance of the
/// gradient is estimated over blocks of the recordings (sandwich; Huber 1967, White 1980).
struct StandardErrors {
  std::vector<Variable> variables;
  Eigen::VectorXd deviation;    // in units of the model
  Eigen::MatrixXd correlation;  // of the searched coordinates
};

StandardErrors standard_errors(const BoundSimulator& bound, const Hypothesis& hypothesis, const FitProblem& problem,
                               const Parallel& parallel);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/fit.ipp"
#endif
