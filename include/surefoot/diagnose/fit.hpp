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

#include "surefoot/diagnose/residuals.hpp"
#include "surefoot/optimize/least_squares.hpp"

namespace surefoot {

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
inline Parallel serially() {
  return [](std::size_t count, const std::function<void(std::size_t)>& job) {
    for (std::size_t i = 0; i < count; ++i) job(i);
  };
}

namespace detail {

/// Residuals and their derivatives as functions of the searched variables.
class FitFunctions {
 public:
  FitFunctions(const Rig& rig, const Hypothesis& start, const FitProblem& problem, const Parallel& parallel)
      : rig_(rig), base_(start), problem_(problem), parallel_(parallel) {
    variables_ = variables_of(rig, start, problem.recordings, problem.free);
    shared_ = static_cast<std::size_t>(std::count_if(
        variables_.begin(), variables_.end(), [](const Variable& v) { return v.kind != Variable::Kind::initial; }));
    begin_.push_back(0);
    for (const std::size_t r : problem.recordings) {
      cells_.push_back(cells_of(rig.recordings[r]));
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

  const Rig& rig_;
  Hypothesis base_;
  const FitProblem& problem_;
  Parallel parallel_;  // a copy: callers hand in temporaries
  std::vector<Variable> variables_;
  std::size_t shared_ = 0;
  std::vector<std::vector<Cell>> cells_;
  std::vector<Eigen::Index> begin_;
};

}  // namespace detail

/// Whether any of these recordings has an initial state to be estimated.
inline bool free_start(const Rig& rig, const std::vector<std::size_t>& recordings) {
  return std::any_of(recordings.begin(), recordings.end(),
                     [&](std::size_t r) { return (rig.recordings[r].initial_scale.array() > 0).any(); });
}

/// Mean robust squared residual.
inline double mean_loss(const Eigen::VectorXd& residuals, double robust) {
  if (residuals.size() == 0) return 0;
  double sum = 0;
  for (const double r : residuals) sum += robust * robust * loss_terms(Loss::huber, r / robust).rho;
  return sum / static_cast<double>(residuals.size());
}

/// Fits a hypothesis, from its own numbers on. Never worse than the start.
inline Fit fit(const Rig& rig, const Hypothesis& start, const FitProblem& problem, const Parallel& parallel) {
  const detail::FitFunctions functions(rig, start, problem, parallel);
  Fit result{.hypothesis = start};
  const Eigen::VectorXd z = functions.start();
  const Eigen::VectorXd first = functions.residuals(z);
  result.loss = mean_loss(first, problem.weighting.robust);
  if (!first.allFinite() || first.size() == 0) return result;
  result.ok = true;
  if (functions.variables().empty()) return result;
  LeastSquaresOptions options;
  options.box = functions.box();
  options.loss = Loss::huber;
  options.loss_scale = problem.weighting.robust;
  options.max_iterations = problem.max_iterations;
  options.tol_cost = problem.tolerance;
  options.tol_step = 1e-6;
  options.covariance = false;
  Eigen::VectorXd asked = z, there = first;  // the last point, whose residuals the Jacobian needs again
  const auto residuals = [&](const Eigen::VectorXd& x) -> const Eigen::VectorXd& {
    if (x != asked) {
      there = functions.residuals(x);
      asked = x;
    }
    return there;
  };
  const auto fitted = least_squares(residuals, z, options,
                                    [&](const Eigen::VectorXd& x) { return functions.jacobian(x, residuals(x)); });
  result.hypothesis = functions.at(fitted.x);
  result.loss = mean_loss(fitted.residuals, problem.weighting.robust);
  return result;
}

/// A hypothesis with the unknown initial states of some recordings estimated, and all else as it is.
inline Hypothesis with_estimated_starts(const Rig& rig, const Hypothesis& hypothesis,
                                        const std::vector<std::size_t>& recordings, FitProblem problem,
                                        const Parallel& parallel) {
  if (!free_start(rig, recordings)) return hypothesis;
  problem.recordings = recordings;
  problem.free = Free::initial_only;
  return fit(rig, hypothesis, problem, parallel).hypothesis;
}

/// Standard errors of the fitted numbers that hold for residuals that are not independent: the covariance of the
/// gradient is estimated over blocks of the recordings (sandwich; Huber 1967, White 1980).
struct StandardErrors {
  std::vector<Variable> variables;
  Eigen::VectorXd deviation;    // in units of the model
  Eigen::MatrixXd correlation;  // of the searched coordinates
};

inline StandardErrors standard_errors(const Rig& rig, const Hypothesis& hypothesis, const FitProblem& problem,
                                      const Parallel& parallel) {
  const detail::FitFunctions functions(rig, hypothesis, problem, parallel);
  const Eigen::VectorXd z = functions.start();
  StandardErrors result{functions.variables(), {}, {}};
  const auto count = static_cast<Eigen::Index>(result.variables.size());
  if (count == 0) return result;
  const Eigen::VectorXd residuals = functions.residuals(z);
  const Eigen::MatrixXd slopes = functions.jacobian(z, residuals);
  Eigen::MatrixXd hessian = slopes.transpose() * slopes, meat = Eigen::MatrixXd::Zero(count, count);
  const Eigen::VectorXd scale = hessian.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  double blocks = 0;
  for (std::size_t i = 0; i + 1 < functions.begin().size(); ++i) {
    const Eigen::Index from = functions.begin()[i], length = functions.begin()[i + 1] - from;
    const Eigen::Index parts = std::clamp<Eigen::Index>(length / 50, 1, 8);
    for (Eigen::Index part = 0; part < parts; ++part) {
      const Eigen::Index a = from + length * part / parts, b = from + length * (part + 1) / parts;
      const Eigen::VectorXd pull =
          scale.cwiseProduct(slopes.middleRows(a, b - a).transpose() * residuals.segment(a, b - a));
      meat += pull * pull.transpose();
      ++blocks;
    }
  }
  Eigen::MatrixXd scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  scaled.diagonal().array() += 1e-9;
  const Eigen::MatrixXd inverse = scaled.ldlt().solve(Eigen::MatrixXd::Identity(count, count));
  Eigen::MatrixXd covariance = inverse * meat * inverse * (blocks / std::max(1.0, blocks - 1));
  covariance = scale.asDiagonal() * covariance * scale.asDiagonal();
  result.deviation.resize(count);
  result.correlation = scale.asDiagonal() * inverse * scale.asDiagonal();
  Eigen::VectorXd norm = result.correlation.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  result.correlation = norm.asDiagonal() * result.correlation * norm.asDiagonal();
  Hypothesis copy = hypothesis;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Variable& variable = result.variables[static_cast<std::size_t>(i)];
    const double unit = variable.logarithmic ? value_of(copy, variable) : variable.scale;
    result.deviation[i] = std::sqrt(std::max(0.0, covariance(i, i))) * unit;
  }
  return result;
}

}  // namespace surefoot
