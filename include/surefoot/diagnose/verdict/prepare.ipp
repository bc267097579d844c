// Definitions of surefoot/diagnose/verdict/prepare.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/verdict/prepare.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

/// Rows before a part that are simulated and not compared; in a map each row starts from readings or a known pose.
SUREFOOT_ONCE Eigen::Index lead_in_rows(SimulatorKind kind, Eigen::Index rows, const PreparationCriteria& criteria) {
  return kind == SimulatorKind::map ? 0 : static_cast<Eigen::Index>(criteria.lead_in * static_cast<double>(rows));
}

/// Rows [begin, to) of recording r as one that starts in these states (state x row), or from what was measured.
SUREFOOT_ONCE Recording part_from_states(const BoundSimulator& bound, std::size_t r, const Eigen::MatrixXd& states,
                                         Eigen::Index begin, Eigen::Index to, const PreparationCriteria& criteria) {
  const Recording& whole = bound.recordings[r];
  Eigen::VectorXd initial = surefoot::detail::column_of(states, begin), scale(initial.size());
  for (Eigen::Index i = 0; i < initial.size(); ++i) {
    const double typical = root_mean_square(surefoot::detail::row_of(states, i));
    scale[i] = std::max(criteria.initial_share * typical, criteria.least_initial);
    const int output = bound.structure.output_of[static_cast<std::size_t>(i)];
    if (output < 0) continue;
    const double measured = whole.outputs(output, begin);
    if (std::isfinite(measured))
      initial[i] = reading_of(bound.structure, static_cast<std::size_t>(i)).state_at(measured);
  }
  return part_of(whole, begin, to, initial, scale);
}

SUREFOOT_ONCE std::vector<Recording> cut_recordings(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                    const std::vector<SimulatedRun>& trajectories, std::size_t parts,
                                                    const PreparationCriteria& criteria) {
  constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();
  std::vector<Recording> result;
  for (std::size_t r = 0; r < bound.recordings.size(); ++r) {
    const Recording& whole = bound.recordings[r];
    for (std::size_t part = 0; part < parts; ++part) {
      const auto count = static_cast<Eigen::Index>(parts), k = static_cast<Eigen::Index>(part);
      const Eigen::Index from = whole.rows() * k / count, to = whole.rows() * (k + 1) / count;
      if (to - from < criteria.part_rows) continue;
      const Eigen::Index begin = from - std::min(from, lead_in_rows(bound.info.kind, to - from, criteria));
      Recording one = part_from_states(bound, r, trajectories[r].states, begin, to, criteria);
      for (Eigen::Index row = 0; row < from - begin; ++row) {
        for (Eigen::Index k = 0; k < one.outputs.rows(); ++k) one.outputs(k, row) = not_measured;
      }
      if (part == 0) one.initial = hypothesis.initial[r];
      result.push_back(std::move(one));
    }
  }
  return result;
}

SUREFOOT_ONCE std::vector<Recording> cut_at_rows(const BoundSimulator& bound, std::size_t r,
                                                 const Eigen::MatrixXd& states, const std::vector<std::size_t>& rows,
                                                 const PreparationCriteria& criteria) {
  std::vector<Recording> result;
  Eigen::Index begin = 0;
  for (std::size_t part = 0; part <= rows.size(); ++part) {
    const Eigen::Index to = part < rows.size() ? static_cast<Eigen::Index>(rows[part]) : bound.recordings[r].rows();
    result.push_back(part_from_states(bound, r, states, begin, to, criteria));
    begin = to;
  }
  return result;
}

SUREFOOT_ONCE void sort_recordings(std::vector<Recording>& recordings) {
  const auto compare = [](const auto& a, const auto& b) {
    return std::lexicographical_compare_three_way(a.data(), a.data() + a.size(), b.data(), b.data() + b.size());
  };
  sort_items(recordings, [&compare](const Recording& a, const Recording& b) {
    if (a.name != b.name) return a.name < b.name;
    const auto times = compare(a.time, b.time);
    return times != 0 ? times < 0 : compare(a.inputs, b.inputs) < 0;
  });
}

/// Whether the first rows hold about their share of the measurements: not where only the end was measured.
SUREFOOT_ONCE bool measured_early(const Recording& one, Eigen::Index rows) {
  constexpr double about = 0.5;  // of their share
  double early = 0, all = 0;
  for (Eigen::Index row = 0; row < one.outputs.cols(); ++row) {
    for (Eigen::Index k = 0; k < one.outputs.rows(); ++k) {
      const bool measured = std::isfinite(one.outputs(k, row));
      all += measured ? 1 : 0;
      early += measured && row < rows ? 1 : 0;
    }
  }
  return early > about * all * static_cast<double>(rows) / static_cast<double>(one.rows());
}

SUREFOOT_ONCE Eigen::Index shorten_recordings(std::vector<Recording>& recordings, std::size_t most) {
  std::vector<std::size_t> rows;
  for (const Recording& one : recordings) rows.push_back(static_cast<std::size_t>(one.rows()));
  sort_items(rows, std::less<>());
  std::size_t left = most, limit = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {  // from the shortest on, each may take an equal share of what is left
    limit = left / (rows.size() - i);
    if (rows[i] > limit) break;
    left -= rows[i];
    limit = 0;
  }
  if (limit == 0) return 0;
  const auto kept = static_cast<Eigen::Index>(limit);
  bool any = false;
  for (Recording& one : recordings) {
    if (one.rows() <= kept || !measured_early(one, kept)) continue;
    const std::string name = one.name;
    one = part_of(one, 0, kept, one.initial, one.initial_scale);
    one.name = name;
    any = true;
  }
  return any ? kept : 0;
}

}  // namespace surefoot::diagnosis
