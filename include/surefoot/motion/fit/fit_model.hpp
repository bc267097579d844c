// Maximum likelihood of a motion model whose noise is known: Gauss-Newton on the innovations of all sequences, whose
// weights follow the model (iteratively reweighted least squares). Cost of an iteration: two displacements per cycle
// and parameter.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "surefoot/core/vec.hpp"
#include "surefoot/motion/fit/pose_filter.hpp"
#include "surefoot/motion/fit/pose_spread.hpp"
#include "surefoot/optimize/least_squares.hpp"

namespace surefoot {

struct ModelFitOptions {
  PoseAccuracy accuracy = {};  // of the measured poses
  Loss loss = Loss::squared;   // huber keeps wrong readings from deciding
  double prior = 0.25;         // parameters lie about their defaults, by this [widths of their ranges]; inf: anywhere
  int max_iterations = 20;     // of new weights
};

template <MotionModel M>
struct ModelFit {
  using Covariance = Eigen::Matrix<double, M::parameter_count, M::parameter_count>;
  M model;
  Covariance covariance;  // of the parameters, for the noise that was given
  double cost = 0;        // half the sum of the losses
  bool converged = false;

  Vec<M::parameter_count> standard_errors() const { return covariance.diagonal().cwiseSqrt(); }
};

namespace detail {

/// Residuals of sequences whose weights are held fixed, and their derivatives.
template <MotionModel M>
class WeightedPoses {
 public:
  static constexpr int n = M::parameter_count;
  using Parameters = Vec<n>;

  WeightedPoses(const M& at, const MotionNoise& noise, const ModelFitOptions& options,
                std::span<const WalkSequence> sequences)
      : sequences_(sequences) {
    for (const WalkSequence& sequence : sequences) {
      weights_.push_back(innovations(at, noise, options.accuracy, sequence));
      for (const Innovation& innovation : weights_.back()) count_ += innovation.error.size();
      shortenings_.push_back(shortenings(sequence, weights_.back(), noise));
    }
    const Box<n> box = parameter_box<M>();
    width_ = box.high() - box.low();
    nominal_ = M().parameters();
    prior_ = options.prior * width_;
  }

  Eigen::VectorXd residuals(const Eigen::VectorXd& p) const {
    const M model = M::from_parameters(Parameters(p));
    Eigen::VectorXd result(count_ + n);
    Eigen::Index next = 0;
    each_innovation(
        model, [&](std::size_t, Eigen::Index, const Vec<3>&, const Pose2&) {},
        [&](const Innovation& weight, const Innovation::Values& error) {
          result.segment(next, error.size()) = weight.whitening * error;
          next += error.size();
        });
    result.tail<n>() = (p - nominal_).cwiseQuotient(prior_);
    return result;
  }

  Eigen::MatrixXd jacobian(const Eigen::VectorXd& p) const {
    const M model = M::from_parameters(Parameters(p));
    std::vector<M> above, below;
    const Parameters step = 1e-5 * width_;
    for (int k = 0; k < n; ++k) {
      Parameters moved = p;
      moved[k] = p[k] + step[k];
      above.push_back(M::from_parameters(moved));
      moved[k] = p[k] - step[k];
      below.push_back(M::from_parameters(moved));
    }
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(count_ + n, n);
    result.bottomRows<n>().diagonal() = prior_.cwiseInverse();
    Eigen::Matrix<double, 3, n> slopes;  // of the pose
    Eigen::Index next = 0;
    each_innovation(
        model,
        [&](std::size_t i, Eigen::Index cycle, const Vec<3>& pose, const Pose2& displacement) {
          if (cycle == 0) slopes.setZero();
          const Vec<3> commands = sequences_[i].commands.col(cycle), previous = sequences_[i].previous_command(cycle);
          Eigen::Matrix<double, 3, n> by_parameters;
          for (int k = 0; k < n; ++k) {
            const auto j = static_cast<std::size_t>(k);
            by_parameters.col(k) = (cycle_displacement(above[j], commands, previous).vec() -
                                    cycle_displacement(below[j], commands, previous).vec()) /
                                   (2 * step[k]);
          }
          by_parameters.template topRows<2>() *= shortenings_[i][cycle];
          slopes = (pose_slope(pose, displacement) * slopes + displacement_slope(pose) * by_parameters).eval();
        },
        [&](const Innovation& weight, const Innovation::Values& error) {
          const Eigen::Index size = error.size();
          result.middleRows(next, size) = -weight.whitening * slopes.topRows(size);
          slopes -= (weight.gain * slopes.topRows(size)).eval();
          next += size;
        });
    return result;
  }

 private:
  /// By cycle: how much shorter its displacement becomes in the mean, since the heading is unsure before it.
  static Eigen::VectorXd shortenings(const WalkSequence& sequence, const std::vector<Innovation>& weights,
                                     const MotionNoise& noise) {
    Eigen::VectorXd result(sequence.cycles());
    auto weight = weights.begin();
    double variance = 0;
    for (Eigen::Index cycle = 0; cycle < sequence.cycles(); ++cycle) {
      result[cycle] = shortening(variance);
      const double turn = noise.deviation(sequence.commands.col(cycle), sequence.previous_command(cycle))[2];
      variance += turn * turn;
      if (weight == weights.end() || weight->cycle != cycle) continue;
      variance = weight->heading_variance;
      ++weight;
    }
    return result;
  }

  /// Follows every sequence: before_cycle(sequence, cycle, pose, expected displacement), and measured(weight, error)
  /// wherever a pose was measured.
  template <class BeforeCycle, class Measured>
  void each_innovation(const M& model, BeforeCycle&& before_cycle, Measured&& measured) const {
    for (std::size_t i = 0; i < sequences_.size(); ++i) {
      const WalkSequence& sequence = sequences_[i];
      Vec<3> pose = Vec<3>::Zero(), previous = sequence.command_before;
      auto weight = weights_[i].begin();
      for (Eigen::Index cycle = 0; cycle < sequence.cycles(); ++cycle) {
        const Vec<3> commands = sequence.commands.col(cycle);
        Pose2 displacement = cycle_displacement(model, commands, previous);
        displacement.x *= shortenings_[i][cycle];
        displacement.y *= shortenings_[i][cycle];
        before_cycle(i, cycle, pose, displacement);
        pose = moved(pose, displacement);
        previous = commands;
        if (weight == weights_[i].end() || weight->cycle != cycle) continue;
        const Innovation::Values error = pose_error(sequence, cycle, pose, weight->error.size());
        measured(*weight, error);
        pose += weight->gain * error;
        ++weight;
      }
    }
  }

  std::span<const WalkSequence> sequences_;
  std::vector<std::vector<Innovation>> weights_;  // by sequence
  std::vector<Eigen::VectorXd> shortenings_;      // by sequence and cycle
  Eigen::Index count_ = 0;                        // of residuals
  Parameters width_, nominal_, prior_;
};

}  // namespace detail

/// Fits the model from `start` on. Throws MotionError if a sequence cannot be used.
template <MotionModel M>
ModelFit<M> fit_model(std::span<const WalkSequence> sequences, const MotionNoise& noise,
                      const ModelFitOptions& options = {}, const M& start = M()) {
  check(sequences);
  constexpr int n = M::parameter_count;
  const Box<n> box = parameter_box<M>();
  const Box<Eigen::Dynamic> range(Eigen::VectorXd(box.low()), Eigen::VectorXd(box.high()));
  LeastSquaresOptions inner{.box = range, .loss = options.loss, .loss_scale = 2.5, .max_iterations = 15};
  inner.tol_step = 1e-9;
  inner.covariance = false;
  ModelFit<M> fit{.model = M::from_parameters(Vec<n>(range.clamp(Eigen::VectorXd(start.parameters())))),
                  .covariance = {}};
  for (int i = 0; i < options.max_iterations && !fit.converged; ++i) {
    const detail::WeightedPoses<M> poses(fit.model, noise, options, sequences);
    const auto result = least_squares([&](const Eigen::VectorXd& p) { return poses.residuals(p); },
                                      Eigen::VectorXd(fit.model.parameters()), inner,
                                      [&](const Eigen::VectorXd& p) { return poses.jacobian(p); });
    const Vec<n> change = (result.x - fit.model.parameters()).cwiseQuotient(box.high() - box.low());
    fit.model = M::from_parameters(Vec<n>(result.x));
    fit.cost = result.cost;
    fit.converged = change.template lpNorm<Eigen::Infinity>() < 1e-6;
  }
  const detail::WeightedPoses<M> poses(fit.model, noise, options, sequences);
  const Eigen::MatrixXd jacobian = poses.jacobian(fit.model.parameters());
  const Eigen::MatrixXd information = jacobian.transpose() * jacobian;
  fit.covariance = information.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  return fit;
}

}  // namespace surefoot
