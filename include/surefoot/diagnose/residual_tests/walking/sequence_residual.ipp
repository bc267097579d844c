// Definitions of surefoot/diagnose/residual_tests/walking/sequence_residual.hpp.
#pragma once

#include <Eigen/Core>
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
#include "surefoot/diagnose/estimation/exponentials.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/typical_sizes.hpp"
#include "surefoot/diagnose/residual_tests/walking/sequence_residual.hpp"
#include "surefoot/optimize/linear_algebra.hpp"
#include "surefoot/optimize/symmetric_eigen.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Eigen::VectorXd features_of_step(const BoundSimulator& bound, std::size_t r, const SimulatedRun& run,
                                               Eigen::Index step, StepFeature feature, const StepScales& scales) {
  const PlanarInfo& planar = *bound.info.planar;
  const Recording& recording = bound.recordings[r];
  const auto one = [](double value) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, value); };
  const auto two = [](double first, double second, double by) {
    Eigen::VectorXd result(2);
    result[0] = first / by;
    result[1] = second / by;
    return result;
  };
  switch (feature) {
    case StepFeature::commands:
    case StepFeature::change_of_commands: {
      const Eigen::Index before = std::max<Eigen::Index>(0, step - 1);
      Eigen::VectorXd result(recording.inputs.rows());
      for (Eigen::Index i = 0; i < result.size(); ++i) {
        const double now = recording.inputs(i, step);
        result[i] = (feature == StepFeature::commands ? now : now - recording.inputs(i, before)) / scales.input[i];
      }
      return result;
    }
    case StepFeature::heading: {
      const double heading = run.states(planar.heading, step);
      return two(std::cos(heading), std::sin(heading), 0.7);
    }
    case StepFeature::place:
      return two(run.states(planar.x, step), run.states(planar.y, step), 0.4 * scales.extent);
    case StepFeature::slip:  // a share of the step, as on slippery floor, that depends on the place
      return two(run.states(planar.x, step), run.states(planar.y, step), 0.15 * scales.extent);
    case StepFeature::time:
      return one(3 * static_cast<double>(step) / static_cast<double>(recording.rows()));
    case StepFeature::parity:
      return one(10 * static_cast<double>(step % 2));
    case StepFeature::third:
      break;
  }
  return one(10 * static_cast<double>(step % 3));
}

SUREFOOT_ONCE Eigen::MatrixXd lever_of_step(const BoundSimulator& bound, const SimulatedRun& run,
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
    const auto moves = [&](double forward, double lateral, double turn) {
      lever(row, 0) = forward;
      lever(row, 1) = lateral;
      lever(row, 2) = turn;
    };
    if (reads(planar.x)) moves(c, -s, -y);
    if (reads(planar.y)) moves(s, c, x);
    if (reads(planar.heading)) moves(0, 0, 1);
  }
  return lever;
}

SUREFOOT_ONCE Eigen::Vector3d moved_in_step(const PlanarInfo& planar, const SimulatedRun& run, Eigen::Index step) {
  const auto pose = [&](Eigen::Index row) {
    return Pose2{run.states(planar.x, row), run.states(planar.y, row), run.states(planar.heading, row)};
  };
  return (pose(step).inverse() * pose(step + 1)).vec();
}

/// Adds one * diag(variance) * sum^T to `block`.
SUREFOOT_INLINE void add_shared_change(Eigen::MatrixXd& block, const Eigen::MatrixXd& one,
                                       const Eigen::Vector3d& variance, const Eigen::MatrixXd& sum) {
  for (Eigen::Index j = 0; j < block.cols(); ++j) {
    for (Eigen::Index i = 0; i < block.rows(); ++i) {
      double shared = one(i, 0) * variance[0] * sum(j, 0);
      for (Eigen::Index k = 1; k < 3; ++k) shared += one(i, k) * variance[k] * sum(j, k);
      block(i, j) += shared;
    }
  }
}

SUREFOOT_INLINE Eigen::MatrixXd sequence_covariance(const std::vector<std::vector<WalkedStep>>& sequences,
                                                    const Eigen::Vector3d& step_size) {
  std::vector<Eigen::Index> begin{0};
  for (const auto& steps : sequences) begin.push_back(begin.back() + (steps.empty() ? 0 : steps[0].lever.rows()));
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(begin.back(), begin.back());
  Eigen::Vector3d variance;
  for (Eigen::Index k = 0; k < 3; ++k) variance[k] = (0.05 * step_size[k]) * (0.05 * step_size[k]);
  for (std::size_t a = 0; a < sequences.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      Eigen::MatrixXd block = Eigen::MatrixXd::Zero(begin[a + 1] - begin[a], begin[b + 1] - begin[b]);
      for (const WalkedStep& one : sequences[a]) {
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(block.cols(), 3);
        Eigen::VectorXd apart(one.features.size());
        for (const WalkedStep& other : sequences[b]) {
          for (Eigen::Index k = 0; k < apart.size(); ++k) apart[k] = one.features[k] - other.features[k];
          const double near = std::exp(-0.5 * surefoot::detail::sum_of_squares(apart));
          for (Eigen::Index k = 0; k < sum.size() && near > 1e-4; ++k) sum.data()[k] += near * other.lever.data()[k];
        }
        add_shared_change(block, one.lever, variance, sum);
      }
      for (Eigen::Index j = 0; j < block.cols(); ++j) {
        for (Eigen::Index i = 0; i < block.rows(); ++i) covariance(begin[a] + i, begin[b] + j) = block(i, j);
      }
      for (Eigen::Index j = 0; j < block.cols(); ++j) {
        for (Eigen::Index i = 0; i < block.rows(); ++i) covariance(begin[b] + j, begin[a] + i) = block(i, j);
      }
    }
  }
  return covariance;
}

SUREFOOT_ONCE double process_evidence(const Eigen::VectorXd& values, const Eigen::VectorXd& turned) {
  const auto n = static_cast<double>(turned.size());
  Eigen::VectorXd squares(turned.size()), variance(turned.size()), ratio(turned.size());
  for (Eigen::Index i = 0; i < squares.size(); ++i) squares[i] = turned[i] * turned[i];
  double best = 0;
  for (const double size : process_sizes) {
    for (const double noise : noise_variances) {  // the scale of both together by its maximum
      for (Eigen::Index i = 0; i < variance.size(); ++i) {
        variance[i] = size * values[i] + noise;
        ratio[i] = squares[i] / variance[i];
      }
      const double scale = std::max(ratio.mean(), 1e-12);
      const double null = std::log(std::max(squares.mean(), 1e-12));
      best = std::max(best, n * (null - std::log(scale)) - logarithms(variance).sum());
    }
  }
  return best;
}

/// factor a x; summed by as many columns at a time as Eigen takes: all if they are few, else 16, or 4 if they are long.
SUREFOOT_INLINE Eigen::VectorXd scaled_product(double factor, const Eigen::MatrixXd& a, const Eigen::VectorXd& x) {
  constexpr Eigen::Index few = 128, long_rows = 4000;  // columns; rows of a column of 32 kB
  const Eigen::Index block = a.cols() < few ? std::max<Eigen::Index>(1, a.cols()) : a.rows() < long_rows ? 16 : 4;
  Eigen::VectorXd result = Eigen::VectorXd::Zero(a.rows());
  for (Eigen::Index begin = 0; begin < a.cols(); begin += block) {
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(a.rows());
    for (Eigen::Index j = begin; j < std::min(begin + block, a.cols()); ++j) {
      for (Eigen::Index i = 0; i < a.rows(); ++i) sums[i] += a(i, j) * x[j];
    }
    for (Eigen::Index i = 0; i < a.rows(); ++i) result[i] += sums[i] * factor;
  }
  return result;
}

SUREFOOT_INLINE Eigen::VectorXd predict_held_out(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& residuals,
                                                 const std::vector<Eigen::Index>& known,
                                                 const std::vector<Eigen::Index>& held_out) {
  const auto count = static_cast<Eigen::Index>(known.size());
  Eigen::MatrixXd among(count, count);
  Eigen::VectorXd y(count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const Eigen::Index column = known[static_cast<std::size_t>(j)];
    y[j] = residuals[column];
    for (Eigen::Index i = 0; i < count; ++i) among(i, j) = covariance(known[static_cast<std::size_t>(i)], column);
  }
  const surefoot::detail::SymmetricEigen eigen = surefoot::detail::eigen_of_symmetric(among);
  const Eigen::VectorXd turned = surefoot::detail::transposed_product(eigen.vectors, y);
  Eigen::VectorXd variance(count), ratio(count), share(count);
  double least = std::numeric_limits<double>::infinity();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(count);
  for (const double size : process_sizes) {
    for (const double noise : noise_variances) {
      for (Eigen::Index i = 0; i < count; ++i) {
        variance[i] = size * std::max(eigen.values[i], 0.0) + noise;
        ratio[i] = turned[i] * turned[i] / variance[i];
        share[i] = turned[i] / variance[i];
      }
      const double cost = logarithms(variance).sum() + ratio.sum();
      if (cost >= least) continue;
      least = cost;
      weights = scaled_product(size, eigen.vectors, share);
    }
  }
  Eigen::VectorXd predicted = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(held_out.size()));
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index i = 0; i < predicted.size(); ++i) {
      predicted[i] +=
          weights[k] * covariance(held_out[static_cast<std::size_t>(i)], known[static_cast<std::size_t>(k)]);
    }
  }
  return predicted;
}

SUREFOOT_INLINE std::vector<double> permuted_evidence(const Eigen::MatrixXd& covariance,
                                                      const Eigen::VectorXd& residuals, std::size_t sequences) {
  const auto count = static_cast<Eigen::Index>(sequences), length = residuals.size() / count;
  if (length * count != residuals.size()) return {};
  const surefoot::detail::SymmetricEigen eigen = surefoot::detail::eigen_of_symmetric(covariance);
  Eigen::VectorXd values = eigen.values;
  for (double& value : values) value = std::max(value, 0.0);
  const auto evidence = [&](const Eigen::VectorXd& shuffled) {
    return process_evidence(values, surefoot::detail::transposed_product(eigen.vectors, shuffled));
  };
  std::vector<double> result{evidence(residuals)};
  Rng rng(1);
  Eigen::VectorXd shuffled = residuals;
  for (int draw = 0; draw < permutations; ++draw) {
    for (Eigen::Index i = count - 1; i > 0; --i) {
      const auto j = static_cast<Eigen::Index>(rng.below(static_cast<std::uint32_t>(i + 1)));
      for (Eigen::Index k = 0; k < length; ++k) std::swap(shuffled[i * length + k], shuffled[j * length + k]);
    }
    result.push_back(evidence(shuffled));
  }
  return result;
}

SUREFOOT_ONCE StepScales step_scales(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                     const std::vector<std::size_t>& recordings,
                                     const std::vector<SimulatedRun>& runs) {
  const Sizes sizes = measure_sizes(bound, hypothesis, recordings, runs);
  const PlanarInfo& planar = *bound.info.planar;
  StepScales scales;
  scales.input.resize(static_cast<Eigen::Index>(sizes.input.size()));
  for (Eigen::Index i = 0; i < scales.input.size(); ++i) scales.input[i] = sizes.input[static_cast<std::size_t>(i)];
  double extent = 0, along = 0, turned = 0, steps = 0;
  for (const SimulatedRun& run : runs) {
    for (Eigen::Index step = 0; step + 1 < run.states.cols(); ++step, ++steps) {
      const auto moved = [&](int state) { return run.states(state, step + 1) - run.states(state, step); };
      extent = std::max({extent, std::abs(run.states(planar.x, step)), std::abs(run.states(planar.y, step))});
      const double x = moved(planar.x), y = moved(planar.y), angle = moved(planar.heading);
      along += 0.5 * (x * x + y * y);
      turned += angle * angle;
    }
  }
  const auto size = [&](double squares) { return std::sqrt(std::max(squares / std::max(steps, 1.0), 1e-24)); };
  scales.step = Eigen::Vector3d(size(along), size(along), size(turned));
  scales.extent = std::max(extent, 1e-9);
  return scales;
}

/// a b; one sum after the other, which for three columns is as Eigen takes them.
SUREFOOT_INLINE Eigen::MatrixXd product_by_columns(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(a.rows(), b.cols());
  for (Eigen::Index j = 0; j < b.cols(); ++j) {
    for (Eigen::Index k = 0; k < a.cols(); ++k) {
      for (Eigen::Index i = 0; i < a.rows(); ++i) result(i, j) += a(i, k) * b(k, j);
    }
  }
  return result;
}

SUREFOOT_ONCE bool SequenceTest::read_off(const KernelChoice& kernel, SequenceData& data) const {
  const PlanarInfo& planar = *bound.info.planar;
  const auto& whitening = problem.weighting.whitening;
  std::vector<Eigen::VectorXd> off(order.size());
  std::vector<std::vector<WalkedStep>> sequences(order.size());
  double size = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::size_t r = order[i];
    std::vector<Cell> cells = cells_of(bound.recordings[r]);
    if (kernel.headings_only) {
      drop_items(cells, [&](const Cell& cell) {
        return bound.structure.output_of[static_cast<std::size_t>(planar.heading)] != static_cast<int>(cell.output);
      });
    }
    off[i] = kernel.headings_only ? raw_residuals(bound, r, runs[i], cells)
                                  : weighted_residuals(bound, r, runs[i], cells, problem.weighting);
    size += surefoot::detail::sum_of_squares(off[i]);
    for (Eigen::Index step = 0; step + 1 < runs[i].states.cols(); ++step) {
      Eigen::MatrixXd lever = lever_of_step(bound, runs[i], cells, step);
      if (!kernel.headings_only && r < whitening.size() && whitening[r].cols() == lever.rows()) {
        lever = product_by_columns(whitening[r], lever);
      }
      if (kernel.feature == StepFeature::slip) {
        const Eigen::Vector3d moved = moved_in_step(planar, runs[i], step);
        for (Eigen::Index k = 0; k < 3; ++k) {
          const double share = moved[k] / scales.step[k];
          for (Eigen::Index i = 0; i < lever.rows(); ++i) lever(i, k) *= share;
        }
      }
      sequences[i].push_back({features_of_step(bound, r, runs[i], step, kernel.feature, scales), std::move(lever)});
    }
  }
  data.begin = {0};
  for (const Eigen::VectorXd& one : off) data.begin.push_back(data.begin.back() + one.size());
  if (data.begin.back() < 20 || !(size > 0)) return false;
  const double scale = kernel.headings_only ? std::sqrt(size / static_cast<double>(data.begin.back())) : 1;
  const double limit = problem.weighting.robust;
  data.residuals.resize(data.begin.back());
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (Eigen::Index k = 0; k < off[i].size(); ++k) {
      data.residuals[data.begin[i] + k] = std::min(std::max(off[i][k] / scale, -limit), limit);
    }
  }
  data.covariance = sequence_covariance(sequences, scales.step);
  data.covariance /= scale * scale;
  return true;
}

SUREFOOT_ONCE Comparison SequenceTest::cross_validated(const SequenceData& data) const {
  const double limit = problem.weighting.robust;
  BlockLosses before, after;
  const auto folds = fold_of.empty() ? 0 : fold_of.back() + 1;
  for (std::size_t fold = 0; fold < folds; ++fold) {
    std::vector<Eigen::Index> known, held_out;
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (Eigen::Index k = data.begin[i]; k < data.begin[i + 1]; ++k) {
        (fold_of[i] == fold ? held_out : known).push_back(k);
      }
    }
    if (known.empty() || held_out.empty()) continue;
    const Eigen::VectorXd predicted = predict_held_out(data.covariance, data.residuals, known, held_out);
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (fold_of[i] != fold) continue;
      const Eigen::Index length = data.begin[i + 1] - data.begin[i];
      Eigen::VectorXd part(length);
      for (Eigen::Index k = 0; k < length; ++k) part[k] = data.residuals[data.begin[i] + k];
      append_losses(before, part, limit);
      for (Eigen::Index k = 0; k < length; ++k) part[k] -= predicted[at + k];
      append_losses(after, part, limit);
      at += length;
    }
  }
  return compare_losses(before, after);
}

SUREFOOT_ONCE Comparison most_evident(std::vector<Comparison> found, const std::vector<std::vector<double>>& evidence) {
  const auto against = [&](std::size_t job, int draw) {
    const std::vector<double>& all = evidence[job];
    double mean = 0, squared = 0;
    for (std::size_t k = 1; k < all.size(); ++k) {
      mean += all[k] / permutations;
      squared += all[k] * all[k] / permutations;
    }
    const double deviation = std::sqrt(std::max(squared - mean * mean, 1e-12));
    return (all[static_cast<std::size_t>(draw)] - mean) / std::max(deviation, 0.5);
  };
  std::size_t best = 0;
  std::vector<double> largest(permutations + 1, -1e300);
  for (std::size_t job = 0; job < found.size(); ++job) {
    if (evidence[job].empty()) continue;
    if (against(job, 0) > largest[0]) best = job;
    for (int draw = 0; draw <= permutations; ++draw) {
      largest[static_cast<std::size_t>(draw)] = std::max(largest[static_cast<std::size_t>(draw)], against(job, draw));
    }
  }
  const auto as_large = count_items(largest, [&](double one) { return one >= largest[0]; });
  found[best].p_value = static_cast<double>(as_large) / static_cast<double>(largest.size());
  return found[best];
}

SUREFOOT_ONCE Comparison sequence_structure(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                            const FitProblem& problem,
                                            const std::vector<std::vector<std::size_t>>& folds,
                                            const Parallel& parallel) {
  SequenceTest test{.bound = bound, .problem = problem};
  for (std::size_t f = 0; f < folds.size(); ++f) {
    append_items(test.order, folds[f]);
    for (std::size_t i = 0; i < folds[f].size(); ++i) test.fold_of.push_back(f);
  }
  if (test.order.size() < 20) return {};
  test.runs = simulate_all(bound, hypothesis, test.order, problem.integration, parallel);
  for (const SimulatedRun& run : test.runs) {
    if (!run.finite) return {};
  }
  test.scales = step_scales(bound, hypothesis, test.order, test.runs);
  // All that was measured, and the headings by themselves, which are sums over steps however far a path goes astray.
  const std::size_t features = std::size(step_features), count = 2 * features;
  std::vector<Comparison> found(count);
  std::vector<std::vector<double>> evidence(count);  // by kernel: as it is, and with permuted sequences
  parallel(count, [&](std::size_t job) {
    SequenceData data;
    if (!test.read_off({.feature = step_features[job % features], .headings_only = job >= features}, data)) return;
    found[job] = test.cross_validated(data);
    evidence[job] = permuted_evidence(data.covariance, data.residuals, test.order.size());
  });
  return most_evident(std::move(found), evidence);
}

}  // namespace surefoot::diagnosis
