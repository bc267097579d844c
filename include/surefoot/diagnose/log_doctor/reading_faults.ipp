// Definitions of surefoot/diagnose/log_doctor/reading_faults.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/sensor_noise.hpp"
#include "surefoot/diagnose/log_doctor/column_faults.hpp"
#include "surefoot/diagnose/log_doctor/constant_stretches.hpp"
#include "surefoot/diagnose/log_doctor/reading_faults.hpp"

namespace surefoot::diagnosis {

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
  constexpr double noises = 3;  // standard deviations of a reading: a sensor whose steps are as large as its noise
                                // then repeats itself in one row of 70 at most and seems to catch up
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

/// Rows that are equal to the one before, and their share of all, but for stretches of many.
struct EqualRows {
  std::vector<RowRange> rows;
  double asked = 0, share = 0;
};

SUREFOOT_ONCE EqualRows equal_rows(const Recording& recording, Eigen::Index output, const LogDoctorCriteria& criteria) {
  EqualRows equal;
  std::size_t in_a_row = 0;
  for (Eigen::Index row = 1; row < recording.rows(); ++row) {
    const double value = recording.outputs(output, row), before = recording.outputs(output, row - 1);
    if (!std::isfinite(value) || !std::isfinite(before)) continue;
    in_a_row = value == before ? in_a_row + 1 : 0;
    if (in_a_row >= criteria.constant_rows) continue;  // a stretch
    ++equal.asked;
    if (in_a_row > 0) equal.rows.emplace_back(row, row + 1);
  }
  equal.share = equal.asked > 0 ? static_cast<double>(equal.rows.size()) / equal.asked : 0;
  return equal;
}

/// Log-likelihood, over that of readings that go on from there, of what follows repeated ones if it makes up for what
/// was missed, as the model moves and with this noise.
SUREFOOT_ONCE double odds_of_catching_up(const LogFit& fit, std::size_t r, Eigen::Index output,
                                         const std::vector<RowRange>& repeated, double noise) {
  const Recording& recording = fit.bound.recordings[r];
  const double variance = 2 * noise * noise;  // of the difference of two readings
  double sum = 0;
  for (const RowRange& one : repeated) {
    const Eigen::Index row = one.first, next = row + 1;
    if (next >= recording.rows() || recording.outputs(output, next) == recording.outputs(output, row)) continue;
    const double step = recording.outputs(output, next) - recording.outputs(output, row);
    const double last = step_of_model(fit, r, output, next), whole = last + step_of_model(fit, r, output, row);
    if (!std::isfinite(step - whole)) continue;
    sum += ((step - last) * (step - last) - (step - whole) * (step - whole)) / (2 * variance);
  }
  return sum;
}

/// Rows that repeat the reading before: more of them than the noise of the sensor lets be equal even at rest and than
/// any other recording has (`shares` of all), with readings after them that catch up; none otherwise. Beside
/// motion_that_shows, for noise that is larger than the sensor's steps.
SUREFOOT_ONCE std::vector<RowRange> repeats_in_spite_of_noise(const LogFit& fit, std::size_t r, Eigen::Index output,
                                                              double resolution, const std::vector<double>& shares,
                                                              const LogDoctorCriteria& criteria) {
  const double noise = noise_of(fit.bound, all_recordings(fit.bound), output);
  if (shares.size() < 2 || !(noise > resolution) || !fit.runs[r].finite) return {};
  const double density = 1 / (2 * noise * std::sqrt(std::numbers::pi));  // at 0, of the difference of two readings
  const double chance = std::max(resolution * density, worst_of_others(shares, r));
  EqualRows equal = equal_rows(fit.bound.recordings[r], output, criteria);
  if (!(chance > 0 && equal.share - chance > criteria.repeats * (1 - chance))) return {};
  const double least_odds = std::log(static_cast<double>(shares.size()) / criteria.significance);
  const double hits = equal.share * equal.asked;
  if (log_likelihood_ratio(hits, equal.asked, chance) < least_odds) return {};
  if (odds_of_catching_up(fit, r, output, equal.rows, noise) < least_odds) return {};
  return std::move(equal.rows);
}

SUREFOOT_ONCE std::vector<FoundFault> repeated_row_faults(const LogFit& fit, Eigen::Index output, double resolution,
                                                          const LogDoctorCriteria& criteria) {
  const std::size_t count = fit.bound.recordings.size();
  const double least_motion = motion_that_shows(fit, output, resolution);
  std::vector<RepeatedRows> repeated(count);
  std::vector<double> equal;  // share of the rows of each recording
  double all_hits = 0, all_rows = 0;
  for (std::size_t r = 0; r < count; ++r) {
    if (fit.runs[r].finite) repeated[r] = repeated_rows(fit, r, output, least_motion, criteria);
    equal.push_back(equal_rows(fit.bound.recordings[r], output, criteria).share);
    all_hits += static_cast<double>(repeated[r].rows.size());
    all_rows += repeated[r].moving;
  }
  std::vector<FoundFault> found;
  const double least_odds = std::log(static_cast<double>(count) / criteria.significance);
  for (std::size_t r = 0; r < count; ++r) {
    std::vector<RowRange> noisy = repeats_in_spite_of_noise(fit, r, output, resolution, equal, criteria);
    if (!noisy.empty()) {
      repeated[r].rows = std::move(noisy);
    } else {
      const double hits = static_cast<double>(repeated[r].rows.size()), rows = repeated[r].moving;
      const double other_hits = all_hits - hits, other_rows = all_rows - rows;
      if (!(hits > criteria.repeats * rows) || hits * other_rows <= criteria.decisive * other_hits * rows) continue;
      const double share = all_hits / all_rows;  // if all recordings repeat alike
      const double odds = log_likelihood_ratio(hits, rows, share) + log_likelihood_ratio(other_hits, other_rows, share);
      if (odds < least_odds) continue;
    }
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

/// The chance that a reading is equal to the one before, as other recordings have it, or this one if it is alone.
SUREFOOT_ONCE double chance_of_repeats(const std::vector<Recording>& recordings, std::size_t r, Eigen::Index output,
                                       const LogDoctorCriteria& criteria) {
  constexpr double one_half = 0.5;  // of a reading: those that were not seen may come yet (Jeffreys' prior)
  double hits = one_half, asked = 1;
  for (std::size_t other = 0; other < recordings.size(); ++other) {
    if (other == r && recordings.size() > 1) continue;
    const EqualRows equal = equal_rows(recordings[other], output, criteria);
    hits += static_cast<double>(equal.rows.size());
    asked += equal.asked;
  }
  return hits / asked;
}

SUREFOOT_ONCE std::vector<FoundFault> find_reading_faults(const LogFit& fit, const LogDoctorCriteria& criteria) {
  std::vector<FoundFault> found;
  const std::size_t count = fit.bound.recordings.size();
  for (Eigen::Index output = 0; output < static_cast<Eigen::Index>(fit.bound.info.outputs.size()); ++output) {
    const double resolution = resolution_of(fit.bound.recordings, output);
    std::vector<std::size_t> repeats(count, 0);
    if (fit.bound.info.kind == SimulatorKind::ode) {
      for (FoundFault& fault : repeated_row_faults(fit, output, resolution, criteria)) {
        repeats[*fault.recording] = fault.repairs.front().rows.size();
        found.push_back(std::move(fault));
      }
    }
    std::vector<std::vector<ConstantStretch>> stretches(count);
    std::vector<double> missed(count), longest(count);
    for (std::size_t r = 0; r < count; ++r) {
      const std::vector<double> lengths = lengths_of_repeats(fit.bound.recordings[r], output);
      const double equal = chance_of_repeats(fit.bound.recordings, r, output, criteria);
      for (const ConstantStretch& one : constant_stretches(fit, r, output, resolution, criteria)) {
        const auto others = lengths_of_repeats(fit.bound.recordings[r], output, one.value);
        const double by_chance = expected_repeats(others, static_cast<double>(one.readings), equal, criteria);
        if (by_chance * static_cast<double>(count) < criteria.significance) stretches[r].push_back(one);
      }
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
      if (auto fault = constant_fault(fit, r, output, stretches[r], natural, criteria))
        found.push_back(std::move(*fault));
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
