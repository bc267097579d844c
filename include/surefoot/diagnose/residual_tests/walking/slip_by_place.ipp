// Definitions of surefoot/diagnose/residual_tests/walking/slip_by_place.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "surefoot/diagnose/residual_tests/forest_correction.hpp"
#include "surefoot/diagnose/residual_tests/walking/slip_by_place.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::optional<MeasuredSteps> measured_steps(const BoundSimulator& bound,
                                                          const std::vector<std::size_t>& recordings,
                                                          const std::vector<SimulatedRun>& runs) {
  if (!bound.info.planar) return std::nullopt;
  const auto output_of = [&](int state) { return bound.structure.output_of[static_cast<std::size_t>(state)]; };
  const int x = output_of(bound.info.planar->x), y = output_of(bound.info.planar->y),
            heading = output_of(bound.info.planar->heading);
  if (x < 0 || y < 0 || heading < 0) return std::nullopt;
  const auto is_finite = [](const Pose2& pose) {
    return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.angle);
  };
  std::vector<double> places, simulations, residuals;  // step by step
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const Eigen::MatrixXd& measured = bound.recordings[recordings[i]].outputs;
    const auto pose = [&](const Eigen::MatrixXd& outputs, Eigen::Index row) {
      return Pose2{outputs(x, row), outputs(y, row), outputs(heading, row)};
    };
    for (Eigen::Index row = 1; row < measured.cols(); ++row) {
      const Pose2 before = pose(measured, row - 1), after = pose(measured, row), expected = pose(runs[i].outputs, row);
      if (!is_finite(before) || !is_finite(after) || !is_finite(expected)) continue;
      const Pose2 back = before.inverse(), simulated = back * expected, moved = back * after;
      for (const double value : {before.x, before.y}) places.push_back(value);
      for (const double value : {simulated.x, simulated.y, simulated.angle}) simulations.push_back(value);
      for (const double value :
           {simulated.x - moved.x, simulated.y - moved.y, wrap_angle(simulated.angle - moved.angle)}) {
        residuals.push_back(value);
      }
    }
  }
  const auto count = static_cast<Eigen::Index>(places.size() / 2);
  MeasuredSteps steps;
  steps.place.resize(2, count);
  steps.simulated.resize(3, count);
  steps.residual.resize(3, count);
  std::copy(places.begin(), places.end(), steps.place.data());
  std::copy(simulations.begin(), simulations.end(), steps.simulated.data());
  std::copy(residuals.begin(), residuals.end(), steps.residual.data());
  return steps;
}

SUREFOOT_ONCE double sign_flip_p_value(const std::vector<double>& terms) {
  constexpr int draws = 4000;
  const double sum = std::accumulate(terms.begin(), terms.end(), 0.0);
  Rng rng(1);
  int as_large = 1;
  for (int draw = 0; draw < draws; ++draw) {
    double flipped = 0;
    for (const double term : terms) flipped += rng.uniform() < 0.5 ? term : -term;
    as_large += flipped >= sum ? 1 : 0;
  }
  return static_cast<double>(as_large) / (draws + 1);
}

SUREFOOT_ONCE Eigen::MatrixXd left_by_slip(const std::vector<MeasuredSteps>& by_fold, std::size_t fold,
                                           std::uint64_t seed) {
  Eigen::Index total = 0, at = 0;
  for (std::size_t g = 0; g < by_fold.size(); ++g) total += g == fold ? 0 : by_fold[g].place.cols();
  Dataset<Eigen::Dynamic, Eigen::Dynamic> known;
  known.inputs.resize(2, total);
  known.outputs.resize(6, total);
  for (std::size_t g = 0; g < by_fold.size(); ++g) {
    if (g == fold) continue;
    const MeasuredSteps& steps = by_fold[g];
    for (Eigen::Index j = 0; j < steps.place.cols(); ++j, ++at) {
      for (Eigen::Index k = 0; k < 2; ++k) known.inputs(k, at) = static_cast<float>(steps.place(k, j));
      for (Eigen::Index k = 0; k < 3; ++k) {
        known.outputs(k, at) = steps.residual(k, j) * steps.simulated(k, j);
        known.outputs(3 + k, at) = steps.simulated(k, j) * steps.simulated(k, j);
      }
    }
  }
  const int min_leaf = std::max(10, static_cast<int>(total / 100));
  const ResidualForest forest = train_forest(known, min_leaf, serially(), seed + fold);
  const MeasuredSteps& held_out = by_fold[fold];
  Eigen::MatrixXd left = held_out.residual;
  for (Eigen::Index j = 0; j < left.cols(); ++j) {
    const Eigen::VectorXd means = forest.predict(surefoot::detail::column_of(held_out.place, j));
    for (Eigen::Index k = 0; k < 3; ++k) {
      left(k, j) -= means[k] / std::max(means[3 + k], 0.05) * held_out.simulated(k, j);
    }
  }
  return left;
}

SUREFOOT_ONCE double squares_of_row(const Eigen::MatrixXd& a, Eigen::Index row) {
  double sum = 0;
  for (Eigen::Index j = 0; j < a.cols(); ++j) sum += a(row, j) * a(row, j);
  return sum;
}

/// The same for each of three rows, the first two by four columns at a time: as Eigen sums over the rows of a matrix.
SUREFOOT_ONCE void add_squares_of_rows(const Eigen::MatrixXd& a, Eigen::Vector3d& sums) {
  for (Eigen::Index k = 0; k < 2 && a.cols() > 0; ++k) {
    const auto square = [&](Eigen::Index j) { return a(k, j) * a(k, j); };
    double sum = square(0);
    Eigen::Index j = 1;
    for (; j < (a.cols() - 1) / 4 * 4; j += 4) sum += square(j) + square(j + 1) + (square(j + 2) + square(j + 3));
    for (; j < a.cols(); ++j) sum += square(j);
    sums[k] += sum;
  }
  sums[2] += squares_of_row(a, 2);
}

SUREFOOT_ONCE Comparison best_direction(const std::vector<MeasuredSteps>& by_fold,
                                        const std::vector<Eigen::MatrixXd>& left) {
  Comparison best;
  const Eigen::Index stretch = memory_of(NoiseKind::process);
  for (Eigen::Index k = 0; k < 3; ++k) {
    double before = 0, after = 0;
    std::vector<double> agreement;  // of what was predicted with what was left, by stretches of steps
    for (std::size_t f = 0; f < by_fold.size(); ++f) {
      before += squares_of_row(by_fold[f].residual, k);
      after += squares_of_row(left[f], k);
      Eigen::VectorXd agreed(left[f].cols());
      for (Eigen::Index j = 0; j < agreed.size(); ++j) {
        agreed[j] = by_fold[f].residual(k, j) * (by_fold[f].residual(k, j) - left[f](k, j));
      }
      for (Eigen::Index from = 0; from < agreed.size(); from += stretch) {
        const Eigen::Index count = std::min(stretch, agreed.size() - from);
        agreement.push_back(Eigen::Map<const Eigen::VectorXd>(agreed.data() + from, count).sum());
      }
    }
    const double gain = before > 0 ? 1 - std::sqrt(after / before) : 0;
    const double p_value = std::min(1.0, 3 * sign_flip_p_value(agreement));
    if (p_value < best.p_value || (p_value == best.p_value && gain > best.gain)) {
      best = {.gain = gain, .stderr_ = 0, .t = 0, .p_value = p_value};
    }
  }
  return best;
}

SUREFOOT_ONCE Comparison slip_by_place(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                       const FitProblem& problem, const std::vector<std::vector<std::size_t>>& folds,
                                       const Parallel& parallel, std::uint64_t seed) {
  std::vector<MeasuredSteps> by_fold;
  Eigen::Vector3d step_square(0, 0, 0), error_square = step_square;
  double count = 0;
  for (const auto& fold : folds) {
    const auto runs = simulate_all(bound, hypothesis, fold, problem.integration, parallel);
    auto steps = measured_steps(bound, fold, runs);
    if (!steps) return {};
    add_squares_of_rows(steps->simulated, step_square);
    add_squares_of_rows(steps->residual, error_square);
    count += static_cast<double>(steps->place.cols());
    by_fold.push_back(std::move(*steps));
  }
  if (count < 100) return {};
  const double limit = problem.weighting.robust;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double step_size = std::max(std::sqrt(step_square[k] / count), 1e-12);
    const double error_size = std::max(std::sqrt(error_square[k] / count), 1e-12);
    for (MeasuredSteps& steps : by_fold) {
      for (Eigen::Index j = 0; j < steps.place.cols(); ++j) {
        steps.simulated(k, j) /= step_size;
        steps.residual(k, j) = std::min(std::max(steps.residual(k, j) / error_size, -limit), limit);
      }
    }
  }
  std::vector<Eigen::MatrixXd> left(by_fold.size());
  parallel(by_fold.size(), [&](std::size_t fold) { left[fold] = left_by_slip(by_fold, fold, seed); });
  return best_direction(by_fold, left);
}

}  // namespace surefoot::diagnosis
