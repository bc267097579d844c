// Definitions of surefoot/diagnose/log_doctor/reading_faults.hpp.
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
#include "surefoot/diagnose/log_doctor/column_faults.hpp"
#include "surefoot/diagnose/log_doctor/reading_faults.hpp"

namespace surefoot::diagnosis {

/// The value that one in twenty exceed.
SUREFOOT_ONCE double high_value(std::vector<double> values) {
  constexpr std::size_t one_in = 20;  // values is above
  const auto high = values.begin() + static_cast<std::ptrdiff_t>(values.size() - 1 - (values.size() - 1) / one_in);
  std::nth_element(values.begin(), high, values.end());
  return *high;
}

SUREFOOT_ONCE double resolution_of(const std::vector<Recording>& recordings, Eigen::Index output) {
  constexpr double rounding = 1e-9;  // of a reading: digits lost in a file are no step
  double least = std::numeric_limits<double>::infinity();
  for (const Recording& recording : recordings) {
    for (Eigen::Index row = 1; row < recording.rows(); ++row) {
      const double value = recording.outputs(output, row);
      const double step = std::abs(value - recording.outputs(output, row - 1));
      if (step > rounding * std::abs(value)) least = std::min(least, step);
    }
  }
  return std::isfinite(least) ? least : 0;
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

/// Whether the model goes beyond the value of a stretch, on that side, for most of it, and by more than it is off anyway:
/// a machine that goes no further there (an end stop, a tank that overflows) is no fault of its sensor.
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
    if (now.readings < static_cast<Eigen::Index>(criteria.constant_rows)) return;
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

/// Motion that is missed in all stretches: their squares, summed.
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

/// How far the model moves into a row from the one before; from the reading there, where it begins each step at one.
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

/// Whether a stretch at the end of the range, of the machine or its sensor, is left again: what sticks does so
/// anywhere.
SUREFOOT_ONCE bool leaves_a_limit(const Recording& recording, const ConstantStretch& stretch) {
  return stretch.extreme && stretch.rows.second < recording.rows();
}

/// Whether no reading of any output changes within these rows.
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

/// Lengths of the stretches in which readings are equal, whatever the model does meanwhile.
SUREFOOT_ONCE std::vector<double> lengths_of_repeats(const Recording& recording, Eigen::Index output) {
  double before = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> lengths;
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {
    const double value = recording.outputs(output, row);
    if (!std::isfinite(value)) continue;
    if (value != before) lengths.push_back(0);
    ++lengths.back();
    before = value;
  }
  return lengths;
}

SUREFOOT_ONCE double expected_repeats(const std::vector<double>& lengths, double readings,
                                      const LogDoctorCriteria& criteria) {
  double pairs = 0, more = 0, asked = 0;
  for (const double length : lengths) {
    if (length < 2 || length >= static_cast<double>(criteria.constant_rows)) continue;
    ++pairs;
    more += length - 2;
    asked += length - 1;
  }
  return pairs > 0 ? pairs * std::pow(more / asked, readings - 2) : 0;
}

/// The stretches of one output and recording that no sensor and no machine explains: clipped or stuck. A model that is
/// off moves on where the machine turns, or where it rests; but of more than `natural` equal readings the noise of the
/// sensor would show in some.
SUREFOOT_ONCE std::optional<FoundFault> constant_fault(const LogFit& fit, std::size_t r, Eigen::Index output,
                                                       const std::vector<ConstantStretch>& stretches, double natural) {
  LogRepair clipped{.kind = LogFaultKind::clipped, .channel = {false, output}};
  LogRepair stuck{.kind = LogFaultKind::stuck, .channel = {false, output}};
  double clipped_rows = 0, stuck_rows = 0;
  const bool steps = fit.bound.integration.restart > 0;  // then the model is never far beyond
  const double off = std::max(fit.typical[output], error_elsewhere(fit, r, output, stretches));
  for (const ConstantStretch& one : stretches) {
    if (machine_rests(fit, r, output, one.rows)) continue;
    const bool noiseless = static_cast<double>(one.readings) > natural;
    const bool jump = ends_in_jump(fit, r, output, one.rows) || moved_on_meanwhile(fit, r, output, one.rows, off);
    if (one.extreme && !jump && (noiseless || one.beyond || steps)) {
      clipped.rows.push_back(one.rows);
      clipped_rows += static_cast<double>(one.readings);
    } else if (noiseless || jump || (one.missed > off && !leaves_a_limit(fit.bound.recordings[r], one))) {
      stuck.rows.push_back(one.rows);
      stuck_rows += static_cast<double>(one.readings);
    }
  }
  if (clipped.rows.empty() && stuck.rows.empty()) return std::nullopt;
  return FoundFault{{clipped_rows > stuck_rows ? clipped : stuck}, r};
}

/// Rows that repeat the reading before although the model moves on by more than the sensor's steps and noise, and all
/// such rows.
struct RepeatedRows {
  std::vector<RowRange> rows;
  double moving = 0;
};

/// Whether the reading after a repeated one makes up for what was missed since row `from`, as the model moves: a
/// machine that rests goes on from where it was.
SUREFOOT_ONCE bool catches_up(const Recording& recording, const Eigen::MatrixXd& simulated, Eigen::Index output,
                              Eigen::Index row, Eigen::Index from) {
  if (row + 1 >= recording.rows()) return false;
  const double step = recording.outputs(output, row + 1) - recording.outputs(output, row);
  const double whole = simulated(output, row + 1) - simulated(output, from);
  const double last = simulated(output, row + 1) - simulated(output, row);
  return std::abs(step - whole) < std::abs(step - last);
}

SUREFOOT_ONCE double motion_that_shows(const LogFit& fit, Eigen::Index output, double resolution) {
  constexpr double steps = 2;   // of the sensor
  constexpr double noises = 4;  // standard deviations of a reading
  return std::max(steps * resolution, noises * noise_of(fit.bound, all_recordings(fit.bound), output));
}

SUREFOOT_ONCE RepeatedRows repeated_rows(const LogFit& fit, std::size_t r, Eigen::Index output, double least_motion,
                                         const LogDoctorCriteria& criteria) {
  const Recording& recording = fit.bound.recordings[r];
  const Eigen::MatrixXd& simulated = fit.runs[r].outputs;
  RepeatedRows result;
  Eigen::Index equal = 0;
  for (Eigen::Index row = 1; row < recording.rows(); ++row) {
    const double value = recording.outputs(output, row), before = recording.outputs(output, row - 1);
    if (!std::isfinite(value) || !std::isfinite(before)) continue;
    equal = value == before ? equal + 1 : 0;
    if (!(std::abs(simulated(output, row) - simulated(output, row - 1)) > least_motion)) continue;
    if (equal >= static_cast<Eigen::Index>(criteria.constant_rows)) continue;  // a stretch
    ++result.moving;
    if (equal > 0 && catches_up(recording, simulated, output, row, row - equal)) {
      result.rows.emplace_back(row, row + 1);
    }
  }
  return result;
}

/// Log-likelihood of a share of rows at its own estimate over that at another share.
SUREFOOT_ONCE double log_likelihood_ratio(double hits, double rows, double share) {
  const auto term = [](double part, double own, double other) { return part > 0 ? part * std::log(own / other) : 0; };
  return rows > 0 ? term(hits, hits / rows, share) + term(rows - hits, 1 - hits / rows, 1 - share) : 0;
}

SUREFOOT_ONCE std::vector<FoundFault> repeated_row_faults(const LogFit& fit, Eigen::Index output, double resolution,
                                                          const LogDoctorCriteria& criteria) {
  const std::size_t count = fit.bound.recordings.size();
  const double least_motion = motion_that_shows(fit, output, resolution);
  std::vector<RepeatedRows> repeated(count);
  double all_hits = 0, all_rows = 0;
  for (std::size_t r = 0; r < count; ++r) {
    if (fit.runs[r].finite) repeated[r] = repeated_rows(fit, r, output, least_motion, criteria);
    all_hits += static_cast<double>(repeated[r].rows.size());
    all_rows += repeated[r].moving;
  }
  std::vector<FoundFault> found;
  const double least_odds = std::log(static_cast<double>(count) / criteria.significance);
  for (std::size_t r = 0; r < count; ++r) {
    const double hits = static_cast<double>(repeated[r].rows.size()), rows = repeated[r].moving;
    const double other_hits = all_hits - hits, other_rows = all_rows - rows;
    if (!(hits > criteria.repeats * rows) || hits * other_rows <= criteria.decisive * other_hits * rows) continue;
    const double share = all_hits / all_rows;  // if all recordings repeat alike
    const double odds =
        log_likelihood_ratio(hits, rows, share) + log_likelihood_ratio(other_hits, other_rows, share);
    if (odds < least_odds) continue;
    found.push_back({{{.kind = LogFaultKind::repeated, .channel = {false, output}, .rows = repeated[r].rows}}, r});
  }
  return found;
}

/// Sensors do not stick all at once, in the same rows: where one of several does and all others stand still, samples
/// were dropped, of all of them.
SUREFOOT_ONCE void take_for_repeated_where_all_stick(const BoundSimulator& bound, std::vector<FoundFault>& found) {
  const auto outputs = static_cast<Eigen::Index>(bound.info.outputs.size());
  if (outputs < 2) return;
  for (const FoundFault& one : std::vector<FoundFault>(found)) {
    const LogRepair& stuck = one.repairs.front();
    const std::size_t r = *one.recording;
    if (stuck.kind != LogFaultKind::stuck || !all_stand_still(bound.recordings[r], stuck.rows)) continue;
    const auto replaced = drop_items(found, [&](const FoundFault& other) {
      return other.recording == r && other.repairs.front().kind == LogFaultKind::stuck &&
             other.repairs.front().rows == stuck.rows;
    });
    if (replaced == 0) continue;  // with those of another output
    LogRepair repeated{.kind = LogFaultKind::repeated};
    for (const RowRange& rows : stuck.rows) {
      for (Eigen::Index row = rows.first + 1; row < rows.second; ++row) repeated.rows.emplace_back(row, row + 1);
    }
    for (repeated.channel.index = 0; repeated.channel.index < outputs; ++repeated.channel.index) {
      found.push_back({{repeated}, r});
    }
  }
}

SUREFOOT_ONCE std::vector<FoundFault> find_reading_faults(const LogFit& fit, const LogDoctorCriteria& criteria) {
  std::vector<FoundFault> found;
  const std::size_t count = fit.bound.recordings.size();
  for (Eigen::Index output = 0; output < static_cast<Eigen::Index>(fit.bound.info.outputs.size()); ++output) {
    const double resolution = resolution_of(fit.bound.recordings, output);
    std::vector<std::size_t> repeats(count, 0);
    if (fit.bound.info.kind == SimulatorKind::ode) {
      for (const FoundFault& fault : repeated_row_faults(fit, output, resolution, criteria)) {
        repeats[*fault.recording] = fault.repairs.front().rows.size();
        found.push_back(fault);
      }
    }
    std::vector<std::vector<ConstantStretch>> stretches(count);
    std::vector<double> missed(count), longest(count);
    for (std::size_t r = 0; r < count; ++r) {
      const std::vector<double> lengths = lengths_of_repeats(fit.bound.recordings[r], output);
      stretches[r] = constant_stretches(fit, r, output, resolution, criteria);
      drop_items(stretches[r], [&](const ConstantStretch& one) {
        const double by_chance = expected_repeats(lengths, static_cast<double>(one.readings), criteria);
        return by_chance * static_cast<double>(count) > criteria.significance;
      });
      missed[r] = total_missed(stretches[r]);
      longest[r] = lengths.empty() ? 0 : *std::max_element(lengths.begin(), lengths.end());
    }
    for (std::size_t r = 0; r < count; ++r) {
      const bool alone = count == 1;  // then nothing says what is natural
      const double natural = alone ? longest[r] : criteria.decisive * worst_of_others(longest, r);
      const bool lasts = longest[r] > natural;
      if (!lasts && !(missed[r] > criteria.decisive * criteria.decisive * worst_of_others(missed, r))) continue;
      Eigen::Index readings = 0;
      for (const ConstantStretch& one : stretches[r]) readings += one.readings;
      if (static_cast<std::size_t>(readings) < repeats[r]) continue;  // some of these in a row
      if (const auto fault = constant_fault(fit, r, output, stretches[r], natural)) found.push_back(*fault);
    }
  }
  take_for_repeated_where_all_stick(fit.bound, found);
  return found;
}

SUREFOOT_ONCE int lost_rows(const Recording& recording) {
  constexpr double longer = 1.5;  // times the usual interval: nearer to two of them than to one
  constexpr double few = 0.05;    // share of the intervals: a clock with more is not regular
  const double usual = median_interval(recording);
  int lost = 0, places = 0;
  for (Eigen::Index row = 1; row < recording.rows(); ++row) {
    const double interval = recording.time[row] - recording.time[row - 1];
    if (interval < longer * usual) continue;
    const bool last = row + 1 == recording.rows();
    const double next = last ? usual : recording.time[row + 1] - recording.time[row];
    if (interval + std::min(next, usual) < (1 + longer) * usual) continue;  // late, and the next one is not
    lost += static_cast<int>(std::round(interval / usual)) - 1;
    ++places;
  }
  return places > few * static_cast<double>(recording.rows() - 1) ? 0 : lost;
}

SUREFOOT_ONCE std::vector<FoundFault> find_gaps(const BoundSimulator& bound, const LogDoctorCriteria& criteria) {
  std::vector<FoundFault> found;
  if (bound.info.kind != SimulatorKind::ode) return found;
  for (std::size_t r = 0; r < bound.recordings.size(); ++r) {
    const Recording& recording = bound.recordings[r];
    if (recording.rows() < static_cast<Eigen::Index>(criteria.fewest_rows)) continue;
    std::vector<double> intervals;
    for (Eigen::Index row = 1; row < recording.rows(); ++row) {
      intervals.push_back(recording.time[row] - recording.time[row - 1]);
    }
    const double middle = median_of(intervals);
    const double least = std::max(criteria.gap * middle, criteria.gap_against_others * high_value(intervals));
    LogRepair gaps{.kind = LogFaultKind::gap};
    for (std::size_t i = 0; i < intervals.size(); ++i) {
      if (intervals[i] > least) {
        gaps.rows.emplace_back(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i) + 1);
      }
    }
    if (!gaps.rows.empty()) found.push_back({{gaps}, r});
  }
  return found;
}

}  // namespace surefoot::diagnosis
