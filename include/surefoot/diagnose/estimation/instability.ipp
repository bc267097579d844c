// Definitions of surefoot/diagnose/estimation/instability.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/estimation/guided_fit.hpp"
#include "surefoot/diagnose/estimation/instability.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

/// A recording in pieces of equal length, each from the states that a simulation close to the readings has there.
SUREFOOT_ONCE std::vector<Recording> pieces_along(const Recording& whole, const Eigen::MatrixXd& states) {
  constexpr Eigen::Index pieces = 16;      // each short enough that the model stays near the readings
  constexpr Eigen::Index fewest_rows = 3;  // of a piece
  std::vector<Recording> result;
  for (Eigen::Index k = 0; k < pieces; ++k) {
    const Eigen::Index from = whole.rows() * k / pieces;
    const Eigen::Index to = std::min(whole.rows() * (k + 1) / pieces + 1, whole.rows());
    if (to - from < fewest_rows) continue;
    const Eigen::VectorXd begin = surefoot::detail::column_of(states, from);
    result.push_back(part_of(whole, from, to, begin, Eigen::VectorXd::Zero(begin.size())));
  }
  return result;
}

/// States at the end of recording r from others at its begin; empty where the simulation runs away.
SUREFOOT_ONCE Eigen::VectorXd end_of(const BoundSimulator& bound, Hypothesis& hypothesis, std::size_t r,
                                     const Eigen::VectorXd& begin) {
  hypothesis.initial[r] = begin;
  const SimulatedRun run = simulate(bound, hypothesis, r, bound.integration);
  return run.finite ? surefoot::detail::column_of(run.states, run.states.cols() - 1) : Eigen::VectorXd();
}

/// By how much differences of states, each in units of its size, have changed at the end of recording r (columns: of
/// which state at the begin); empty where a simulation runs away.
SUREFOOT_ONCE Eigen::MatrixXd transition(const BoundSimulator& bound, Hypothesis hypothesis, std::size_t r,
                                         const Eigen::VectorXd& sizes) {
  constexpr double small = 1e-5;  // of the size: a difference that grows without meeting another regime
  const Eigen::VectorXd begin = bound.recordings[r].initial, end = end_of(bound, hypothesis, r, begin);
  if (end.size() == 0) return {};
  Eigen::MatrixXd result(end.size(), end.size());
  for (Eigen::Index state = 0; state < end.size(); ++state) {
    Eigen::VectorXd moved = begin;
    moved[state] += small * sizes[state];
    const Eigen::VectorXd other = end_of(bound, hypothesis, r, moved);
    if (other.size() == 0) return {};
    for (Eigen::Index i = 0; i < end.size(); ++i) result(i, state) = (other[i] - end[i]) / (small * sizes[i]);
  }
  return result;
}

/// Logarithm of the most that differences grow by over a recording; -infinity where it cannot be said.
SUREFOOT_ONCE double log_growth(BoundSimulator bound, const Hypothesis& hypothesis, std::size_t r) {
  constexpr double close = 0.5;      // Integration::follow of the motion along which they grow
  constexpr double smallest = 1e-9;  // size of a state that is always 0
  constexpr double unknown = -std::numeric_limits<double>::infinity();
  Integration near = bound.integration;
  near.follow = close;
  const SimulatedRun motion = simulate(bound, hypothesis, r, near);
  if (!motion.finite) return unknown;
  Eigen::VectorXd sizes(motion.states.rows());
  for (Eigen::Index i = 0; i < sizes.size(); ++i) {
    sizes[i] = std::max(root_mean_square(surefoot::detail::row_of(motion.states, i)), smallest);
  }
  Eigen::MatrixXd change = surefoot::detail::identity(sizes.size(), sizes.size());
  double sum = 0;
  for (Recording& piece : pieces_along(bound.recordings[r], motion.states)) {
    bound.recordings[r] = std::move(piece);
    const Eigen::MatrixXd next = transition(bound, hypothesis, r, sizes);
    if (next.size() == 0) return unknown;
    change = surefoot::detail::product(next, change);
    const double size = std::sqrt(surefoot::detail::dot(change.data(), change.data(), change.size()));
    if (!(size > 0) || !std::isfinite(size)) return unknown;
    change /= size;
    sum += std::log(size);
  }
  return sum;
}

/// Growth over each recording, and how long it is [s].
struct GrowthOverRecording {
  double logarithm = 0, seconds = 0;
};

/// The recording over which differences grow as fast as over most.
SUREFOOT_ONCE GrowthOverRecording median_growth(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                const Parallel& parallel) {
  std::vector<GrowthOverRecording> all(bound.recordings.size());
  parallel(all.size(), [&](std::size_t r) {
    const Recording& one = bound.recordings[r];
    all[r] = {log_growth(bound, hypothesis, r), one.time[one.rows() - 1] - one.time[0]};
  });
  const auto slower = [&all](std::size_t a, std::size_t b) {
    return all[a].logarithm * all[b].seconds < all[b].logarithm * all[a].seconds;
  };
  return all[sorted_places(all.size(), slower)[all.size() / 2]];
}

SUREFOOT_ONCE double growth_rate(const BoundSimulator& bound, const Hypothesis& hypothesis, const Parallel& parallel) {
  const GrowthOverRecording growth = median_growth(bound, hypothesis, parallel);
  return growth.logarithm / growth.seconds;
}

/// By how much a channel changes over a fiftieth of its rows: root mean square, where both are known.
SUREFOOT_ONCE double typical_change(const Eigen::MatrixXd& channels, Eigen::Index k) {
  constexpr Eigen::Index parts = 50;  // of the recording
  const Eigen::Index apart = std::max<Eigen::Index>(1, channels.cols() / parts);
  double sum = 0;
  int count = 0;
  for (Eigen::Index row = apart; row < channels.cols(); ++row) {
    const double change = channels(k, row) - channels(k, row - apart);
    if (!std::isfinite(change)) continue;
    sum += change * change;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

SUREFOOT_ONCE double needed_follow(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                   const Parallel& parallel) {
  constexpr double forgotten = 1000;  // times a difference: what it began with does not matter any more
  constexpr double faster = 3;        // than differences grow: following shrinks them, and reaches far ahead still
  constexpr double most = 0.5;        // rows far apart
  if (bound.info.kind == SimulatorKind::map || !can_follow(bound)) return 0;
  const GrowthOverRecording growth = median_growth(bound, hypothesis, parallel);
  if (!(growth.logarithm > std::log(forgotten))) return 0;
  return std::min(most, faster * growth.logarithm / growth.seconds * shortest_interval(bound, all_recordings(bound)));
}

SUREFOOT_ONCE bool moves_as_measured(const BoundSimulator& bound, const Hypothesis& hypothesis) {
  constexpr double more = 2;  // times: what falls over, or runs away, moves far more than what is held
  std::size_t alike = 0;
  for (std::size_t r = 0; r < bound.recordings.size(); ++r) {
    const SimulatedRun free = simulate(bound, hypothesis, r, bound.integration);
    bool as_measured = free.finite;
    for (Eigen::Index k = 0; as_measured && k < free.outputs.rows(); ++k) {
      const double measured = typical_change(bound.recordings[r].outputs, k);
      as_measured = typical_change(free.outputs, k) <= more * measured;
    }
    alike += as_measured ? 1 : 0;
  }
  return 2 * alike > bound.recordings.size();
}

}  // namespace surefoot::diagnosis
