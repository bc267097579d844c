// Definitions of surefoot/diagnose/estimation/sensitive_starts.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/sensitive_starts.hpp"
#include "surefoot/diagnose/estimation/sensor_noise.hpp"

namespace surefoot::diagnosis {

/// By output: standard deviation of what a reading is off by.
SUREFOOT_ONCE Eigen::VectorXd reading_errors(const BoundSimulator& bound, std::size_t r) {
  Eigen::VectorXd result(bound.recordings[r].outputs.rows());
  for (Eigen::Index k = 0; k < result.size(); ++k) {
    result[k] = std::max(noise_of(bound, {r}, k), rounding_error(bound, {r}, k));
  }
  return result;
}

/// First row at which three simulations, of which the first two begin at the same distance from the third on either
/// side, part by more than their starts explain; as many as there are rows if they do not.
SUREFOOT_ONCE Eigen::Index row_of_parting(const SimulatedRun& above, const SimulatedRun& below,
                                          const SimulatedRun& middle, const Eigen::VectorXd& noise) {
  constexpr double far = 10;     // times the noise
  constexpr double bent = 0.25;  // of the larger difference: what both sides have in common, 0 where they are opposite
  const Eigen::Index rows = middle.outputs.cols();
  if (!above.finite || !below.finite || !middle.finite) return rows;
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index k = 0; k < noise.size(); ++k) {
      const double a = above.outputs(k, row) - middle.outputs(k, row);
      const double b = below.outputs(k, row) - middle.outputs(k, row);
      const double larger = std::max(std::abs(a), std::abs(b));
      if (noise[k] > 0 && larger > far * noise[k] && std::abs(0.5 * (a + b)) > bent * larger) return row;
    }
  }
  return rows;
}

/// By how many standard errors the first rows of all outputs tell both starts from the one between them.
SUREFOOT_ONCE double told_apart_by(const SimulatedRun& above, const SimulatedRun& below, const Eigen::VectorXd& noise,
                                   Eigen::Index rows) {
  double squares = 0;
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index k = 0; k < noise.size(); ++k) {
      const double half = 0.5 * (above.outputs(k, row) - below.outputs(k, row));
      if (noise[k] > 0) squares += half * half / (noise[k] * noise[k]);
    }
  }
  return std::sqrt(squares);
}

/// The row of parting of recording r, from these states on, each known up to `errors` standard errors of the first
/// `near` rows; the least over the states that are measured.
SUREFOOT_ONCE Eigen::Index first_parting(const BoundSimulator& bound, Hypothesis hypothesis, std::size_t r,
                                         const Eigen::VectorXd& begin, double errors, Eigen::Index near,
                                         const Eigen::VectorXd& noise) {
  const auto simulated_from = [&](std::size_t state, double moved) {
    hypothesis.initial[r] = begin;
    hypothesis.initial[r][static_cast<Eigen::Index>(state)] += moved;
    return simulate(bound, hypothesis, r, bound.integration);
  };
  const SimulatedRun middle = simulated_from(0, 0);
  Eigen::Index first = bound.recordings[r].rows();
  for (std::size_t i = 0; i < bound.structure.output_of.size(); ++i) {
    const int output = bound.structure.output_of[i];
    if (output < 0 || !(noise[output] > 0)) continue;
    // as its own sensor tells it; where a heading is known by where it leads, all sensors do so better
    const double readings = std::sqrt(static_cast<double>(near));
    const double own = errors * noise[output] / (readings * reading_of(bound.structure, i).slope);
    const SimulatedRun above = simulated_from(i, own), below = simulated_from(i, -own);
    Eigen::Index parting = row_of_parting(above, below, middle, noise);
    if (parting >= first) continue;
    const double told = told_apart_by(above, below, noise, near);
    if (told > errors) {
      const double moved = own * errors / told;
      parting = row_of_parting(simulated_from(i, moved), simulated_from(i, -moved), middle, noise);
    }
    first = std::min(first, parting);
  }
  return first;
}

SUREFOOT_ONCE std::vector<std::size_t> sensitive_rows(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                      std::size_t r, const Eigen::MatrixXd& states) {
  constexpr Eigen::Index pieces = 16;      // borders of equal pieces, where a recording may be cut
  constexpr Eigen::Index least_rows = 20;  // of a part
  constexpr double errors = 2 * 2;         // standard errors: two, and twice that at the end of a line through readings
  const Recording& whole = bound.recordings[r];
  const Eigen::Index all = whole.rows(), least = std::max(all / pieces, least_rows);
  const Eigen::VectorXd noise = reading_errors(bound, r);
  const auto parting_after = [&](Eigen::Index from) {
    const Eigen::VectorXd begin = surefoot::detail::column_of(states, from);
    if (from == 0) return first_parting(bound, hypothesis, r, begin, errors, least, noise);
    BoundSimulator rest = bound;
    rest.recordings[r] = part_of(whole, from, all, begin, whole.initial_scale);
    return from + first_parting(rest, hypothesis, r, begin, errors, least, noise);
  };
  std::vector<std::size_t> rows;
  Eigen::Index from = 0;
  while (all - from > 2 * least) {
    const Eigen::Index parting = parting_after(from);
    if (parting >= all) break;
    const Eigen::Index border = (parting * pieces / all) * all / pieces;  // the last one before
    from = std::min(std::max(from + least, border), all - least);
    rows.push_back(static_cast<std::size_t>(from));
  }
  return rows;
}

}  // namespace surefoot::diagnosis
