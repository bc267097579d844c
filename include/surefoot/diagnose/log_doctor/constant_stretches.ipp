// Definitions of surefoot/diagnose/log_doctor/constant_stretches.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/sensor_noise.hpp"
#include "surefoot/diagnose/log_doctor/constant_stretches.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE double high_value(std::vector<double> values) {
  constexpr std::size_t one_in = 20;  // values is above
  const auto high = values.begin() + static_cast<std::ptrdiff_t>(values.size() - 1 - (values.size() - 1) / one_in);
  std::nth_element(values.begin(), high, values.end());
  return *high;
}

/// How much the model moves over these rows: standard deviation, or what it expects of a step that begins at the
/// reading.
SUREFOOT_ONCE double missed_motion(const LogFit& fit, std::size_t r, Eigen::Index output, const RowRange& rows) {
  const bool steps = fit.bound.integration.restart > 0;
  double sum = 0, squares = 0, count = 0;
  for (Eigen::Index row = rows.first; row < rows.second; ++row) {
    const double value = steps ? fit.residuals[r](output, row) : fit.runs[r].outputs(output, row);
    if (!std::isfinite(value)) continue;
    sum += value;
    squares += value * value;
    ++count;
  }
  if (count < 2) return 0;
  const double mean = steps ? 0 : sum / count;
  return std::sqrt(std::max(0.0, squares / count - mean * mean));
}

/// Whether a stretch is at the recording's largest (1) or smallest (-1) value; 0: neither.
SUREFOOT_ONCE int end_of_range(const Recording& recording, Eigen::Index output, double value) {
  bool highest = true, lowest = true;
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {
    const double other = recording.outputs(output, row);
    highest = highest && !(other > value);
    lowest = lowest && !(other < value);
  }
  return highest ? 1 : lowest ? -1 : 0;
}

/// Whether the model goes beyond the value of a stretch, on that side, for most of it, and by more than it is off
/// anyway: a machine that goes no further there (an end stop, a tank that overflows) is no fault of its sensor.
SUREFOOT_ONCE bool goes_beyond(const LogFit& fit, std::size_t r, Eigen::Index output, const ConstantStretch& stretch,
                               int side) {
  Eigen::Index beyond = 0;
  for (Eigen::Index row = stretch.rows.first; row < stretch.rows.second; ++row) {
    if (side * (fit.runs[r].outputs(output, row) - stretch.value) > fit.typical[output]) ++beyond;
  }
  return 2 * beyond > stretch.rows.second - stretch.rows.first;
}

SUREFOOT_ONCE std::vector<ConstantStretch> constant_stretches(const LogFit& fit, std::size_t r, Eigen::Index output,
                                                              double resolution, const LogDoctorCriteria& criteria) {
  constexpr double steps_missed = 3;  // of the sensor's: less motion than that it may not show
  const Recording& recording = fit.bound.recordings[r];
  std::vector<ConstantStretch> stretches;
  if (!fit.runs[r].finite) return stretches;
  ConstantStretch now{{0, 0}, 0, std::numeric_limits<double>::quiet_NaN()};
  const auto close = [&] {
    if (now.readings < static_cast<Eigen::Index>(criteria.fewest_equal)) return;
    now.missed = missed_motion(fit, r, output, now.rows);
    const int side = end_of_range(recording, output, now.value);
    now.extreme = side != 0;
    now.beyond = side != 0 && goes_beyond(fit, r, output, now, side);
    if (now.missed > steps_missed * resolution) stretches.push_back(now);
  };
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {
    const double value = recording.outputs(output, row);
    if (!std::isfinite(value)) continue;
    if (value != now.value) {
      close();
      now = {{row, row}, 0, value};
    }
    now.rows.second = row + 1;
    ++now.readings;
  }
  close();
  return stretches;
}

SUREFOOT_ONCE double total_missed(const std::vector<ConstantStretch>& stretches) {
  double sum = 0;
  for (const ConstantStretch& one : stretches) sum += static_cast<double>(one.readings) * one.missed * one.missed;
  return sum;
}

/// Whether a stretch ends with a jump: a machine that sticks moves on from where it was.
SUREFOOT_ONCE bool ends_in_jump(const LogFit& fit, std::size_t r, Eigen::Index output, const RowRange& rows) {
  constexpr double jump = 5;  // times the 95 % quantile of the steps in this recording
  const Recording& recording = fit.bound.recordings[r];
  std::vector<double> steps;
  for (Eigen::Index row = 1; row < recording.rows(); ++row) {
    const double step = std::abs(recording.outputs(output, row) - recording.outputs(output, row - 1));
    if (std::isfinite(step) && (row < rows.first || row > rows.second)) steps.push_back(step);
  }
  if (steps.empty() || rows.second >= recording.rows()) return false;
  const double step = recording.outputs(output, rows.second) - recording.outputs(output, rows.second - 1);
  return std::abs(step) > jump * high_value(steps);
}

SUREFOOT_ONCE double step_of_model(const LogFit& fit, std::size_t r, Eigen::Index output, Eigen::Index row) {
  const bool steps = fit.bound.integration.restart > 0;
  const Eigen::MatrixXd& simulated = fit.runs[r].outputs;
  return simulated(output, row) - (steps ? fit.bound.recordings[r].outputs : simulated)(output, row - 1);
}

/// Whether the reading after a stretch is where the model has gone meanwhile, and neither at the stretch nor one step
/// on from it, if that is further than the model is off: the machine moved on, and its sensor did not say so. What is
/// at a limit, of the machine or its sensor, goes on from there.
SUREFOOT_ONCE bool moved_on_meanwhile(const LogFit& fit, std::size_t r, Eigen::Index output, const RowRange& rows,
                                      double off) {
  const Recording& recording = fit.bound.recordings[r];
  const Eigen::Index next = rows.second;
  if (next >= recording.rows()) return false;
  const double step = recording.outputs(output, next) - recording.outputs(output, next - 1);
  const double last = step_of_model(fit, r, output, next);
  double whole = last, squares = off * off;
  for (Eigen::Index row = rows.first + 1; row < next; ++row) {
    whole += step_of_model(fit, r, output, row);
    if (fit.bound.integration.restart > 0) squares += off * off;  // of each step
  }
  constexpr double certain = 4;  // standard deviations
  const double beyond = std::min(std::abs(whole), std::abs(whole - last));
  return beyond > certain * std::sqrt(squares) &&
         std::abs(step - whole) < std::min(std::abs(step), std::abs(step - last));
}

/// Share of the rows of recordings other than r, where the model moves by no more than a step, that repeat the reading
/// before, with one more that does; `again`: of those where that one did so as well.
SUREFOOT_ONCE double chance_in_step(const LogFit& fit, std::size_t r, Eigen::Index output, double step, bool again) {
  double rows = 1, equal = 1;
  for (std::size_t o = 0; o < fit.runs.size(); ++o) {
    const Eigen::MatrixXd& read = fit.bound.recordings[o].outputs;
    for (Eigen::Index row = again ? 2 : 1; o != r && fit.runs[o].finite && row < read.cols(); ++row) {
      const double before = read(output, row - 1);
      if (!(std::abs(step_of_model(fit, o, output, row)) <= step) || (again && before != read(output, row - 2)))
        continue;
      ++rows;
      if (read(output, row) == before) ++equal;
    }
  }
  return equal / rows;
}

SUREFOOT_ONCE double expected_by_chance(const LogFit& fit, std::size_t r, Eigen::Index output,
                                        const ConstantStretch& stretch, double off) {
  const Eigen::MatrixXd& read = fit.bound.recordings[r].outputs;
  const auto [first, next] = stretch.rows;
  constexpr double no_sign = std::numeric_limits<double>::infinity();
  if (stretch.extreme || next >= read.cols()) return no_sign;
  double whole = 0;
  for (Eigen::Index row = first + 1; row < next; ++row) whole += step_of_model(fit, r, output, row);
  const double step = read(output, next) - read(output, next - 1);
  const double beside = (step - step_of_model(fit, r, output, next)) / off, caught_up = beside - whole / off;
  if (!(std::abs(caught_up) < std::abs(beside))) return no_sign;
  double expected = std::exp((caught_up * caught_up - beside * beside) / 2), rows = 0;
  for (const Recording& recording : fit.bound.recordings) rows += static_cast<double>(recording.rows());
  for (Eigen::Index row = first + 1; row < next; ++row) {
    const double moved = std::abs(step_of_model(fit, r, output, row));
    expected *= chance_in_step(fit, r, output, moved, row > first + 1);
  }
  return rows * expected;
}

/// Whether a stretch at the end of the range, of the machine or its sensor, is left again: what sticks does so
/// anywhere.
SUREFOOT_ONCE bool leaves_a_limit(const Recording& recording, const ConstantStretch& stretch) {
  return stretch.extreme && stretch.rows.second < recording.rows();
}

SUREFOOT_ONCE bool all_stand_still(const Recording& recording, const std::vector<RowRange>& rows) {
  for (const RowRange& one : rows) {
    for (Eigen::Index row = one.first + 1; row < one.second; ++row) {
      for (Eigen::Index k = 0; k < recording.outputs.rows(); ++k) {
        if (recording.outputs(k, row) != recording.outputs(k, row - 1)) return false;
      }
    }
  }
  return true;
}

/// How much of the model's motion over these rows a sensor shows, by least squares; nothing where its noise hides that.
SUREFOOT_ONCE std::optional<double> share_of_motion_shown(const LogFit& fit, std::size_t r, Eigen::Index output,
                                                          const RowRange& rows) {
  constexpr double certain = 4;  // standard errors that the whole motion is worth
  const Recording& recording = fit.bound.recordings[r];
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (Eigen::Index row = rows.first; row < rows.second; ++row) {
    const double simulated = fit.runs[r].outputs(output, row), measured = recording.outputs(output, row);
    if (!std::isfinite(simulated) || !std::isfinite(measured)) continue;
    n += 1, x += simulated, y += measured, xx += simulated * simulated, xy += simulated * measured;
  }
  const double motion = n > 0 ? xx - x * x / n : 0;
  const double noise = noise_of(fit.bound, all_recordings(fit.bound), output);
  if (!(std::sqrt(std::max(motion, 0.0)) > certain * noise)) return std::nullopt;
  return (xy - x * y / n) / motion;
}

/// Whether other sensors say that the machine rests in these rows, where the model moves on.
SUREFOOT_ONCE bool machine_rests(const LogFit& fit, std::size_t r, Eigen::Index output, const RowRange& rows) {
  constexpr double half = 0.5;  // of the motion: nearer to rest than to the model
  bool rests = false;
  for (Eigen::Index k = 0; k < fit.bound.recordings[r].outputs.rows(); ++k) {
    const auto shown = k == output ? std::nullopt : share_of_motion_shown(fit, r, k, rows);
    if (shown && *shown > half) return false;
    rests = rests || shown;
  }
  return rests && !all_stand_still(fit.bound.recordings[r], {rows});
}

/// How far the model is off elsewhere in this recording: root mean square.
SUREFOOT_ONCE double error_elsewhere(const LogFit& fit, std::size_t r, Eigen::Index output,
                                     const std::vector<ConstantStretch>& stretches) {
  const Eigen::Index later = fit.bound.integration.restart > 0 ? 1 : 0;  // the row after begins at a reading within
  double sum = 0, count = 0;
  for (Eigen::Index row = 0; row < fit.residuals[r].cols(); ++row) {
    const double off = fit.residuals[r](output, row);
    const bool within = holds_for_any(
        stretches, [&](const ConstantStretch& one) { return row >= one.rows.first && row < one.rows.second + later; });
    if (within || !std::isfinite(off)) continue;
    sum += off * off;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

SUREFOOT_ONCE std::vector<double> lengths_of_repeats(const Recording& recording, Eigen::Index output, double but_for) {
  double before = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> lengths;
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {
    const double value = recording.outputs(output, row);
    if (!std::isfinite(value)) continue;
    if (value != but_for) {
      if (value != before) lengths.push_back(0);
      ++lengths.back();
    }
    before = value;
  }
  return lengths;
}

SUREFOOT_ONCE double expected_repeats(const std::vector<double>& lengths, double readings, double equal_to_the_last,
                                      const LogDoctorCriteria& criteria) {
  double rows = 0, pairs = 0, more = 0, asked = 0;
  for (const double length : lengths) {
    rows += length;
    if (length < 2 || length >= static_cast<double>(criteria.constant_rows)) continue;
    ++pairs;
    more += length - 2;
    asked += length - 1;
  }
  const double goes_on = std::max(pairs > 0 ? more / asked : 0, equal_to_the_last);
  return std::max(pairs, equal_to_the_last * rows) * std::pow(goes_on, readings - 2);
}

/// Adds all rows that read this value, unless they are there.
SUREFOOT_ONCE void add_rows_at(const Recording& recording, Eigen::Index output, double value,
                               std::vector<RowRange>& rows) {
  for (const RowRange& one : rows) {
    if (recording.outputs(output, one.first) == value) return;
  }
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {
    if (recording.outputs(output, row) != value) continue;
    if (row == 0 || recording.outputs(output, row - 1) != value) rows.emplace_back(row, row);
    rows.back().second = row + 1;
  }
}

SUREFOOT_ONCE std::optional<FoundFault> constant_fault(const LogFit& fit, std::size_t r, Eigen::Index output,
                                                       const std::vector<ConstantStretch>& stretches, double natural,
                                                       const LogDoctorCriteria& criteria) {
  LogRepair clipped{.kind = LogFaultKind::clipped, .channel = {false, output}};
  LogRepair stuck{.kind = LogFaultKind::stuck, .channel = {false, output}};
  double clipped_rows = 0, stuck_rows = 0;
  const bool steps = fit.bound.integration.restart > 0;  // then the model is never far beyond
  const double off = std::max(fit.typical[output], error_elsewhere(fit, r, output, stretches));
  for (const ConstantStretch& one : stretches) {
    if (machine_rests(fit, r, output, one.rows)) continue;
    const bool noiseless = static_cast<double>(one.readings) > natural ||
                           expected_by_chance(fit, r, output, one, off) < criteria.significance;
    const bool jump = ends_in_jump(fit, r, output, one.rows) || moved_on_meanwhile(fit, r, output, one.rows, off);
    if (one.extreme && !jump && (noiseless || one.beyond || steps)) {
      add_rows_at(fit.bound.recordings[r], output, one.value, clipped.rows);  // short visits as well
      clipped_rows += static_cast<double>(one.readings);
    } else if (noiseless || jump || (one.missed > off && !leaves_a_limit(fit.bound.recordings[r], one))) {
      stuck.rows.push_back(one.rows);
      stuck_rows += static_cast<double>(one.readings);
    }
  }
  if (clipped.rows.empty() && stuck.rows.empty()) return std::nullopt;
  return FoundFault{{clipped_rows > stuck_rows ? clipped : stuck}, r};
}

}  // namespace surefoot::diagnosis
