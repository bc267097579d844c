// Definitions of surefoot/diagnose/residual_tests/walking/sequence_residual.hpp.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/cross_validation.hpp"
#include "surefoot/diagnose/residual_tests/walking/sequence_residual.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE Eigen::VectorXd features_of_step(const BoundSimulator& bound, std::size_t r, const SimulatedRun& run,
                                                 Eigen::Index step, StepFeature feature,
                                                 const Eigen::VectorXd& input_scale, double extent) {
  const PlanarInfo& planar = *bound.info.planar;
  const Recording& recording = bound.recordings[r];
  const double heading = run.states(planar.heading, step);
  switch (feature) {
    case StepFeature::orders:
      return recording.inputs.col(step).cwiseQuotient(input_scale);
    case StepFeature::change_of_orders:
      return (recording.inputs.col(step) - recording.inputs.col(std::max<Eigen::Index>(0, step - 1)))
          .cwiseQuotient(input_scale);
    case StepFeature::heading:
      return Eigen::Vector2d(std::cos(heading), std::sin(heading)) / 0.7;
    case StepFeature::place:
      return Eigen::Vector2d(run.states(planar.x, step), run.states(planar.y, step)) / (0.4 * extent);
    case StepFeature::slip:  // a share of the step, as on slippery floor, that depends on the place
      return Eigen::Vector2d(run.states(planar.x, step), run.states(planar.y, step)) / (0.15 * extent);
    case StepFeature::time:
      return Eigen::VectorXd::Constant(1, 3 * static_cast<double>(step) / static_cast<double>(recording.rows()));
    case StepFeature::parity:
      return Eigen::VectorXd::Constant(1, 10 * static_cast<double>(step % 2));
    case StepFeature::third:
      break;
  }
  return Eigen::VectorXd::Constant(1, 10 * static_cast<double>(step % 3));
}

SUREFOOT_INLINE Eigen::MatrixXd lever_of_step(const BoundSimulator& bound, const SimulatedRun& run,
                                              const std::vector<Cell>& cells, Eigen::Index step) {
  const PlanarInfo& planar = *bound.info.planar;
  const Eigen::Index last = run.states.cols() - 1;
  const double heading = run.states(planar.heading, step), c = std::cos(heading), s = std::sin(heading);
  const double x = run.states(planar.x, last) - run.states(planar.x, step + 1);
  const double y = run.states(planar.y, last) - run.states(planar.y, step + 1);
  Eigen::MatrixXd lever = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(cells.size()), 3);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto reads = [&](int state) {
      return bound.structure.output_of[static_cast<std::size_t>(state)] == static_cast<int>(cells[i].output);
    };
    if (reads(planar.x)) lever.row(row) << c, -s, -y;
    if (reads(planar.y)) lever.row(row) << s, c, x;
    if (reads(planar.heading)) lever.row(row) << 0, 0, 1;
  }
  return lever;
}

SUREFOOT_INLINE Eigen::Vector3d moved_in_step(const PlanarInfo& planar, const SimulatedRun& run, Eigen::Index step) {
  const auto pose = [&](Eigen::Index row) {
    return Pose2{run.states(planar.x, row), run.states(planar.y, row), run.states(planar.heading, row)};
  };
  return (pose(step).inverse() * pose(step + 1)).vec();
}

SUREFOOT_INLINE Eigen::MatrixXd sequence_covariance(const std::vector<std::vector<WalkedStep>>& sequences,
                                                    const Eigen::Vector3d& step_size) {
  std::vector<Eigen::Index> begin{0};
  for (const auto& steps : sequences) begin.push_back(begin.back() + (steps.empty() ? 0 : steps[0].lever.rows()));
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(begin.back(), begin.back());
  const Eigen::Vector3d variance = (0.05 * step_size).array().square();
  for (std::size_t a = 0; a < sequences.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      Eigen::MatrixXd block = Eigen::MatrixXd::Zero(begin[a + 1] - begin[a], begin[b + 1] - begin[b]);
      for (const WalkedStep& one : sequences[a]) {
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(block.cols(), 3);
        for (const WalkedStep& other : sequences[b]) {
          const double near = std::exp(-0.5 * (one.features - other.features).squaredNorm());
          if (near > 1e-4) sum += near * other.lever;
        }
        block += one.lever * variance.asDiagonal() * sum.transpose();
      }
      covariance.block(begin[a], begin[b], block.rows(), block.cols()) = block;
      covariance.block(begin[b], begin[a], block.cols(), block.rows()) = block.transpose();
    }
  }
  return covariance;
}

SUREFOOT_INLINE double process_evidence(const Eigen::ArrayXd& values, const Eigen::ArrayXd& turned) {
  const auto n = static_cast<double>(turned.size());
  const Eigen::ArrayXd squares = turned.square();
  double best = 0;
  for (const double size : process_sizes) {
    for (const double noise : noise_variances) {  // the scale of both together by its maximum
      const Eigen::ArrayXd variance = size * values + noise;
      const double scale = std::max((squares / variance).mean(), 1e-12);
      const double null = std::log(std::max(squares.mean(), 1e-12));
      best = std::max(best, n * (null - std::log(scale)) - variance.log().sum());
    }
  }
  return best;
}

SUREFOOT_INLINE Eigen::VectorXd predict_held_out(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& residuals,
                                                 const std::vector<Eigen::Index>& known,
                                                 const std::vector<Eigen::Index>& held) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance(known, known));
  const Eigen::VectorXd values = eigen.eigenvalues().cwiseMax(0), y = residuals(known);
  const Eigen::VectorXd turned = eigen.eigenvectors().transpose() * y;
  double least = std::numeric_limits<double>::infinity();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(y.size());
  for (const double size : process_sizes) {
    for (const double noise : noise_variances) {
      const Eigen::ArrayXd variance = size * values.array() + noise;
      const double cost = variance.log().sum() + (turned.array().square() / variance).sum();
      if (cost >= least) continue;
      least = cost;
      weights = size * (eigen.eigenvectors() * (turned.array() / variance).matrix());
    }
  }
  return covariance(held, known) * weights;
}

SUREFOOT_INLINE std::vector<double> permuted_evidence(const Eigen::MatrixXd& covariance,
                                                      const Eigen::VectorXd& residuals, std::size_t sequences) {
  const auto count = static_cast<Eigen::Index>(sequences), length = residuals.size() / count;
  if (length * count != residuals.size()) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  const Eigen::ArrayXd values = eigen.eigenvalues().cwiseMax(0);
  std::vector<double> result{process_evidence(values, (eigen.eigenvectors().transpose() * residuals).array())};
  Rng rng(1);
  Eigen::VectorXd shuffled = residuals;
  for (int draw = 0; draw < permutations; ++draw) {
    for (Eigen::Index i = count - 1; i > 0; --i) {
      const auto j = static_cast<Eigen::Index>(rng.below(static_cast<std::uint32_t>(i + 1)));
      for (Eigen::Index k = 0; k < length; ++k) std::swap(shuffled[i * length + k], shuffled[j * length + k]);
    }
    result.push_back(process_evidence(values, (eigen.eigenvectors().transpose() * shuffled).array()));
  }
  return result;
}

SUREFOOT_INLINE Comparison sequence_structure(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                              const FitProblem& problem,
                                              const std::vector<std::vector<std::size_t>>& folds,
                                              const Parallel& parallel) {
  std::vector<std::size_t> order, fold_of;
  for (std::size_t f = 0; f < folds.size(); ++f) {
    order.insert(order.end(), folds[f].begin(), folds[f].end());
    fold_of.insert(fold_of.end(), folds[f].size(), f);
  }
  if (order.size() < 20) return {};
  const auto runs = simulate_all(bound, hypothesis, order, problem.integration, parallel);
  const Sizes sizes = measure_sizes(bound, hypothesis, order, runs);
  const PlanarInfo& planar = *bound.info.planar;
  Eigen::VectorXd input_scale(static_cast<Eigen::Index>(sizes.input.size()));
  for (Eigen::Index i = 0; i < input_scale.size(); ++i) input_scale[i] = sizes.input[static_cast<std::size_t>(i)];
  double extent = 0, squares[3] = {}, steps = 0;
  for (const SimulatedRun& run : runs) {
    if (!run.finite) return {};
    for (Eigen::Index step = 0; step + 1 < run.states.cols(); ++step, ++steps) {
      extent = std::max({extent, std::abs(run.states(planar.x, step)), std::abs(run.states(planar.y, step))});
      const auto moved = (run.states.col(step + 1) - run.states.col(step)).eval();
      squares[0] += 0.5 * (moved[planar.x] * moved[planar.x] + moved[planar.y] * moved[planar.y]);
      squares[2] += moved[planar.heading] * moved[planar.heading];
    }
  }
  squares[1] = squares[0];
  Eigen::Vector3d step_size;
  for (int k = 0; k < 3; ++k) step_size[k] = std::sqrt(std::max(squares[k] / std::max(steps, 1.0), 1e-24));

  // All that was measured, and the headings by themselves, which are sums over steps however far a path goes astray.
  const std::size_t features = std::size(step_features), count = 2 * features;
  std::vector<Comparison> found(count);
  std::vector<std::vector<double>> evidence(count);  // by kernel: as it is, and with permuted sequences
  parallel(count, [&](std::size_t job) {
    const StepFeature feature = step_features[job % features];
    const bool headings_only = job >= features;
    std::vector<std::vector<WalkedStep>> sequences(order.size());
    std::vector<Eigen::VectorXd> off(order.size());
    double size = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      std::vector<Cell> cells = cells_of(bound.recordings[order[i]]);
      if (headings_only) {
        std::erase_if(cells, [&](const Cell& cell) {
          return bound.structure.output_of[static_cast<std::size_t>(planar.heading)] != static_cast<int>(cell.output);
        });
      }
      off[i] = headings_only ? raw_residuals(bound, order[i], runs[i], cells)
                             : weighted_residuals(bound, order[i], runs[i], cells, problem.weighting);
      size += off[i].squaredNorm();
      const auto& whitening = problem.weighting.whitening;
      for (Eigen::Index step = 0; step + 1 < runs[i].states.cols(); ++step) {
        Eigen::MatrixXd lever = lever_of_step(bound, runs[i], cells, step);
        if (!headings_only && order[i] < whitening.size() && whitening[order[i]].cols() == lever.rows()) {
          lever = (whitening[order[i]] * lever).eval();
        }
        if (feature == StepFeature::slip) {
          lever *= moved_in_step(planar, runs[i], step).cwiseQuotient(step_size).asDiagonal();
        }
        sequences[i].push_back(
            {features_of_step(bound, order[i], runs[i], step, feature, input_scale, std::max(extent, 1e-9)),
             std::move(lever)});
      }
    }
    std::vector<Eigen::Index> begin{0};
    for (const Eigen::VectorXd& one : off) begin.push_back(begin.back() + one.size());
    if (begin.back() < 20 || !(size > 0)) return;
    const double scale = headings_only ? std::sqrt(size / static_cast<double>(begin.back())) : 1;
    const double limit = problem.weighting.robust;
    Eigen::VectorXd y(begin.back());
    for (std::size_t i = 0; i < order.size(); ++i) {
      y.segment(begin[i], off[i].size()) = (off[i] / scale).cwiseMax(-limit).cwiseMin(limit);
    }
    const Eigen::MatrixXd covariance = sequence_covariance(sequences, step_size) / (scale * scale);
    BlockLosses before, after;
    for (std::size_t fold = 0; fold < folds.size(); ++fold) {
      std::vector<Eigen::Index> known, held;
      for (std::size_t i = 0; i < order.size(); ++i) {
        for (Eigen::Index k = begin[i]; k < begin[i + 1]; ++k) (fold_of[i] == fold ? held : known).push_back(k);
      }
      if (known.empty() || held.empty()) continue;
      const Eigen::VectorXd predicted = predict_held_out(covariance, y, known, held);
      Eigen::Index at = 0;
      for (std::size_t i = 0; i < order.size(); ++i) {
        if (fold_of[i] != fold) continue;
        const Eigen::Index length = begin[i + 1] - begin[i];
        append_losses(before, y.segment(begin[i], length), limit);
        append_losses(after, y.segment(begin[i], length) - predicted.segment(at, length), limit);
        at += length;
      }
    }
    found[job] = compare_losses(before, after);
    evidence[job] = permuted_evidence(covariance, y, order.size());
  });
  // The largest evidence of any kernel, against the largest that permuted sequences give.
  std::size_t best = 0;
  const auto against = [&](std::size_t job, int draw) {
    const std::vector<double>& all = evidence[job];
    double mean = 0, squared = 0;
    for (std::size_t k = 1; k < all.size(); ++k) {
      mean += all[k] / permutations;
      squared += all[k] * all[k] / permutations;
    }
    const double spread = std::sqrt(std::max(squared - mean * mean, 1e-12));
    return (all[static_cast<std::size_t>(draw)] - mean) / std::max(spread, 0.5);
  };
  std::vector<double> largest(permutations + 1, -1e300);
  for (std::size_t job = 0; job < count; ++job) {
    if (evidence[job].empty()) continue;
    if (against(job, 0) > largest[0]) best = job;
    for (int draw = 0; draw <= permutations; ++draw) {
      largest[static_cast<std::size_t>(draw)] = std::max(largest[static_cast<std::size_t>(draw)], against(job, draw));
    }
  }
  const auto as_large = std::count_if(largest.begin(), largest.end(), [&](double one) { return one >= largest[0]; });
  found[best].p_value = static_cast<double>(as_large) / static_cast<double>(largest.size());
  return found[best];
}

}  // namespace surefoot::diagnosis
