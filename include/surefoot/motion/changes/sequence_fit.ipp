// Definitions of surefoot/motion/changes/sequence_fit.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/motion/changes/sequence_fit.hpp"
#include "surefoot/motion/monitor/cholesky.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"
#include "surefoot/optimize/linear_algebra.hpp"
#include "surefoot/optimize/symmetric_eigen.hpp"

namespace surefoot {

namespace detail {

SUREFOOT_INLINE Eigen::MatrixXd map_eigenvalues(const Eigen::MatrixXd& a, const std::function<double(double)>& f) {
  const SymmetricEigen eigen = eigen_of_symmetric(a);
  Eigen::MatrixXd scaled = eigen.vectors;
  for (Eigen::Index k = 0; k < scaled.cols(); ++k) {
    const double value = f(eigen.values[k]);
    for (Eigen::Index i = 0; i < scaled.rows(); ++i) scaled(i, k) *= value;
  }
  return product(scaled, transposed(eigen.vectors));
}

/// a b a for a symmetric `a`.
SUREFOOT_INLINE Eigen::MatrixXd sandwich(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::MatrixXd whole = product(a, product(b, a));
  return 0.5 * (whole + transposed(whole));
}

SUREFOOT_INLINE Eigen::VectorXd widths(const AnyMotionModel& model) { return model.parameter_box().width(); }

/// All sequences linearized about one model, and the prior.
struct LinearizedSequences {
  std::vector<InformationUpdate> updates = {};
  Eigen::MatrixXd information;  // the prior included
  Eigen::VectorXd offset;       // the prior included
  double cost = 0;              // sum of squares, the prior included
};

SUREFOOT_INLINE LinearizedSequences linearize_all(std::span<const WalkSequence> sequences, const MotionTracker& tracker,
                                                  const ParameterPrior& prior) {
  const Eigen::VectorXd missing = prior.mean - tracker.model.parameters();
  const Eigen::VectorXd offset = product(prior.information, missing);
  LinearizedSequences result{.information = prior.information, .offset = offset};
  result.cost = dot(missing.data(), offset.data(), missing.size());
  for (const WalkSequence& sequence : sequences) {
    result.updates.push_back(linearize(tracker, sequence));
    result.information += result.updates.back().information;
    result.offset += result.updates.back().offset;
    result.cost += result.updates.back().rest;
  }
  return result;
}

/// Gauss-Newton; steps that make the fit worse are halved. The tracker's model becomes the fitted one.
SUREFOOT_INLINE LinearizedSequences converge(std::span<const WalkSequence> sequences, MotionTracker& tracker,
                                             const ParameterPrior& prior) {
  constexpr int most_steps = 20, most_halvings = 6;  // far more than fits of a linear correction need
  constexpr double negligible = 1e-6;                // step [widths of the parameters' ranges]
  LinearizedSequences here = linearize_all(sequences, tracker, prior);
  for (int step = 0; step < most_steps; ++step) {
    const Cholesky root(here.information);
    if (!root.ok()) throw MotionError("the coefficients of the walk cannot be fitted to these sequences");
    Eigen::VectorXd move = root.solve(here.offset);
    const AnyMotionModel from = tracker.model;
    bool better = false;
    for (int halving = 0; halving < most_halvings && !better; ++halving, move *= 0.5) {
      tracker.model =
          from.with_parameters(from.parameter_box().clamp(Eigen::VectorXd(from.parameters() + move)));
      LinearizedSequences there = linearize_all(sequences, tracker, prior);
      better = there.cost < here.cost;
      if (better) here = std::move(there);
    }
    if (!better) {
      tracker.model = from;
      return here;
    }
    const Eigen::VectorXd moved = tracker.model.parameters() - from.parameters();
    if ((moved.array() / widths(from).array()).abs().maxCoeff() < negligible) return here;
  }
  return here;
}

/// What the residuals of a sequence would be if the fit had not followed them (CR2).
SUREFOOT_INLINE Eigen::VectorXd unfitted(const Eigen::VectorXd& score, const Eigen::MatrixXd& leverage) {
  constexpr double most = 0.999;  // of leverage: a direction that one sequence alone decides says nothing of spread
  return product(map_eigenvalues(leverage, [&](double l) { return 1 / std::sqrt(1 - std::clamp(l, 0.0, most)); }),
                 score);
}

}  // namespace detail

SUREFOOT_INLINE SequenceFit fit_sequences(std::span<const WalkSequence> sequences, const AnyMotionModel& start,
                                          const MotionNoise& noise, const PoseAccuracy& accuracy,
                                          const ParameterPrior& prior) {
  check(sequences);
  MotionTracker tracker{.model = start, .noise = noise, .accuracy = accuracy};
  const detail::LinearizedSequences fitted = detail::converge(sequences, tracker, prior);
  const Eigen::VectorXd width = detail::widths(start);
  const Eigen::MatrixXd scaled = detail::scaled(width, fitted.information);
  SequenceFit fit{.model = tracker.model};
  fit.root = detail::map_eigenvalues(scaled, [](double value) { return 1 / std::sqrt(value); });
  fit.prior_share = detail::sandwich(fit.root, detail::scaled(width, prior.information));
  const auto count = static_cast<Eigen::Index>(sequences.size());
  fit.squares.resize(count);
  fit.counts.resize(count);
  Eigen::Index next = 0;
  for (const InformationUpdate& update : fitted.updates) {
    const Eigen::MatrixXd leverage = detail::sandwich(fit.root, detail::scaled(width, update.information));
    const Eigen::VectorXd score = detail::product(fit.root, Eigen::VectorXd(width.cwiseProduct(update.offset)));
    fit.contributions.push_back(detail::unfitted(score, leverage));
    fit.squares[next] = update.rest;
    fit.counts[next++] = static_cast<double>(update.count);
    fit.spent += leverage.trace();
  }
  return fit;
}

SUREFOOT_INLINE Eigen::MatrixXd SequenceFit::covariance(const Eigen::MatrixXd& inflation) const {
  const Eigen::MatrixXd seen = detail::map_eigenvalues(
      prior_share, [](double value) { return std::sqrt(std::clamp(1 - value, 0.0, 1.0)); });
  const Eigen::MatrixXd whole = detail::sandwich(root, detail::sandwich(seen, inflation) + prior_share);
  return detail::scaled(detail::widths(model), whole);
}

SUREFOOT_INLINE Eigen::MatrixXd covariance_inflation(std::span<const SequenceFit* const> fits) {
  double sequences = 0, seen = 0;
  const Eigen::Index n = fits.front()->root.rows();
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(n, n);
  for (const SequenceFit* fit : fits) {
    const auto count = static_cast<double>(fit->contributions.size());
    sequences += count;
    for (const Eigen::VectorXd& score : fit->contributions) mean += count * (score * score.transpose());
    seen += count * (static_cast<double>(n) - fit->prior_share.trace());
  }
  mean /= sequences;
  const double average = mean.trace() / std::max(seen / sequences, 1e-9);
  const Eigen::MatrixXd target = average * Eigen::MatrixXd::Identity(n, n);
  double chance = 0;  // squared error of the mean
  for (const SequenceFit* fit : fits) {
    const auto count = static_cast<double>(fit->contributions.size());
    for (const Eigen::VectorXd& score : fit->contributions) {
      chance += (count * (score * score.transpose()) - mean).squaredNorm();
    }
  }
  const double distance = (mean - target).squaredNorm();
  const double share = sequences < 2 || distance <= 0
                           ? 1.0
                           : std::min(1.0, chance / (sequences * (sequences - 1)) / distance);
  return share * target + (1 - share) * mean;
}

}  // namespace surefoot
