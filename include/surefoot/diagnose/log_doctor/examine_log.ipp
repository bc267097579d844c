// Definitions of surefoot/diagnose/log_doctor/examine_log.hpp.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/log_doctor/describe_fault.hpp"
#include "surefoot/diagnose/log_doctor/examine_log.hpp"
#include "surefoot/diagnose/log_doctor/jumps.hpp"
#include "surefoot/diagnose/log_doctor/odd_recording.hpp"
#include "surefoot/diagnose/log_doctor/reading_faults.hpp"
#include "surefoot/optimize/linear_algebra.hpp"

namespace surefoot::diagnosis {

/// An examination under way: the recordings without the faults so far, and the model calibrated to them.
struct LogUnderExamination {
  const LogDoctorInputs& inputs;
  LogFit fit;
  std::vector<LogFault> faults;
  std::vector<LogFault> suspected = {};
  std::vector<Recording> without_suspected = {};
  std::vector<Recording> before_jumps = {};  // those that were cut at one

  void add(std::vector<LogFault> more, bool repaired) {
    for (LogFault& fault : more) {
      fault.repaired = repaired;
      faults.push_back(std::move(fault));
    }
  }
  void calibrate_again(std::vector<Recording> recordings) {
    fit = fit_log(inputs, std::move(recordings), fit.hypothesis.parameters);
  }
};

/// Calibrated from the nominal parameters on, or from others where that fails.
SUREFOOT_ONCE LogFit first_fit(const LogDoctorInputs& inputs, const std::vector<Recording>& recordings) {
  LogFit fit = fit_log(inputs, recordings);
  if (worst_output_error(fit) < inputs.criteria.poor_fit) return fit;
  LogFit other = fit_log(inputs, recordings, {}, inputs.criteria.search_points);
  return median_of(other.error) < median_of(fit.error) ? other : fit;
}

/// The longest piece of a recording between gaps. Where it does not begin with the first row it starts from the
/// readings and the simulated states there, to be estimated.
SUREFOOT_ONCE Recording longest_piece(const LogFit& fit, std::size_t r, const LogRepair& gaps) {
  constexpr double initial_share = 0.2;  // of a state's root mean square: by how much it may be off there
  const Recording& whole = fit.bound.recordings[r];
  RowRange best{0, 0};
  Eigen::Index from = 0;
  for (std::size_t i = 0; i <= gaps.rows.size(); ++i) {
    const Eigen::Index to = i < gaps.rows.size() ? gaps.rows[i].second : whole.rows();
    if (to - from > best.second - best.first) best = {from, to};
    from = to;
  }
  if (!fit.runs[r].finite) return whole;
  Eigen::VectorXd initial = surefoot::detail::column_of(fit.runs[r].states, best.first), scale = initial;
  for (Eigen::Index i = 0; i < initial.size(); ++i) {
    scale[i] = initial_share * root_mean_square(surefoot::detail::row_of(fit.runs[r].states, i));
    const int output = fit.bound.structure.output_of[static_cast<std::size_t>(i)];
    if (output >= 0 && std::isfinite(whole.outputs(output, best.first))) {
      initial[i] =
          reading_of(fit.bound.structure, static_cast<std::size_t>(i)).state_at(whole.outputs(output, best.first));
    }
  }
  Recording piece = part_of(whole, best.first, best.second, initial, scale);
  piece.name = whole.name;
  return piece;
}

SUREFOOT_ONCE void examine_readings(LogUnderExamination& log) {
  const LogDoctorCriteria& criteria = log.inputs.criteria;
  const std::vector<FoundFault> found = find_reading_faults(log.fit, criteria);
  std::vector<Recording> recordings = log.fit.bound.recordings;
  for (const FoundFault& fault : found) {
    log.add(describe_fault(log.fit.bound, fault), true);
    recordings[*fault.recording] = repaired(log.fit.bound, recordings[*fault.recording], fault.repairs);
  }
  std::vector<FoundFault> cuts = find_gaps(log.fit.bound, criteria);
  if (cuts.empty()) add_jumps(log.fit, criteria, cuts);
  for (const FoundFault& cut : cuts) {
    const std::size_t r = *cut.recording;
    const Recording before = std::exchange(log.fit.bound.recordings[r], recordings[r]);
    recordings[r] = longest_piece(log.fit, r, cut.repairs.front());
    if (cut.repairs.front().kind == LogFaultKind::jump) log.before_jumps.push_back(before);
    log.add(describe_fault(log.fit.bound, cut), recordings[r].rows() < before.rows());
  }
  if (!log.faults.empty()) log.calibrate_again(std::move(recordings));
}

SUREFOOT_ONCE double sum_of_amounts(const ClockFault& fault) {
  double sum = 0;
  for (const double amount : fault.amounts) sum += amount;
  return sum;
}

/// Whether one clock runs fast and the other slow.
SUREFOOT_ONCE bool are_opposite(const ClockFault& one, const ClockFault& other) {
  return one.kind == other.kind && one.kind != LogFaultKind::offset && sum_of_amounts(one) * sum_of_amounts(other) < 0;
}

SUREFOOT_ONCE void examine_clocks(LogUnderExamination& log) {
  const std::vector<Recording> as_logged = log.fit.bound.recordings;
  const auto other_faults = static_cast<std::ptrdiff_t>(log.faults.size());
  std::optional<ClockFault> earlier;
  for (std::size_t round = 0; 2 * round < log.fit.bound.recordings.size() && !log.inputs.stopped(); ++round) {
    const auto fault = find_clock_fault(log.inputs, log.fit);
    if (!fault || log.inputs.stopped()) break;
    if (earlier && are_opposite(*earlier, *fault)) {  // the clocks of one robot do not run fast and slow
      log.faults.erase(log.faults.begin() + other_faults, log.faults.end());
      log.calibrate_again(as_logged);
      return;
    }
    earlier = fault;
    std::vector<LogFault> named = describe_fault(log.fit.bound, *fault);
    std::vector<Recording> recordings = log.fit.bound.recordings;
    for (std::size_t r = 0; r < recordings.size(); ++r) {
      if (fault->amounts[r] == 0) continue;
      recordings[r] = repaired(log.fit.bound, recordings[r], {.kind = fault->kind, .amount = fault->amounts[r]});
    }
    if (!fault->decisive) {
      log.suspected = std::move(named);
      log.without_suspected = std::move(recordings);
      return;
    }
    log.add(std::move(named), true);
    log.calibrate_again(std::move(recordings));
    std::size_t off = 0;
    for (const double amount : fault->amounts) off += amount != 0 ? 1 : 0;
    if (off > 1) break;  // all were estimated together
  }
}

SUREFOOT_ONCE void examine_columns(LogUnderExamination& log) {
  constexpr int most_of_all = 3;  // faults of the whole log, one after the other
  for (int round = 0; round < most_of_all && !log.inputs.stopped(); ++round) {
    const auto found = find_fault_of_all(log.inputs, log.fit);
    if (!found || log.inputs.stopped()) break;  // what a comparison that was cut short says does not count
    log.add(describe_fault(log.fit.bound, *found), true);
    std::vector<Recording> recordings = log.fit.bound.recordings;
    for (Recording& recording : recordings) recording = repaired(log.fit.bound, recording, found->repairs);
    log.fit = first_fit(log.inputs, recordings);
  }
  for (std::size_t round = 0; 2 * round < log.fit.bound.recordings.size() && !log.inputs.stopped(); ++round) {
    auto found = find_fault_of_one(log.inputs, log.fit);
    if (found && clock_explains_more(log.inputs, log.fit, *found)) {
      examine_clocks(log);
      found = find_fault_of_one(log.inputs, log.fit);
    }
    if (!found || log.inputs.stopped()) break;
    log.add(describe_fault(log.fit.bound, *found), true);
    std::vector<Recording> recordings = log.fit.bound.recordings;
    Recording& one = recordings[*found->recording];
    one = repaired(log.fit.bound, one, found->repairs);
    log.calibrate_again(std::move(recordings));
  }
}

/// That a recording jumps says a model that does not hold for it: not named, and its rows are there again.
SUREFOOT_ONCE void withdraw_jump(LogUnderExamination& log, Recording& odd) {
  for (const Recording& whole : log.before_jumps) {
    if (whole.name != odd.name) continue;
    odd = whole;
    drop_items(log.faults, [&](const LogFault& fault) {
      return fault.recording == odd.name && fault.kind == name_of(LogFaultKind::jump) && fault.channel.empty();
    });
  }
}

/// A recording unlike the others. Columns or a unit of time that are at fault may have led the calibration astray, so
/// that they show only beside one without that recording. With nothing to repair it is left out.
SUREFOOT_ONCE void examine_odd_recording(LogUnderExamination& log) {
  auto odd = find_odd_recording(log.inputs, log.fit);
  if (!odd || log.inputs.stopped()) return;
  const LogFit others = predicted_without(log.inputs, log.fit, odd->recording);
  if (const auto found = find_fault_of_one(log.inputs, others, odd->recording)) {
    log.add(describe_fault(log.fit.bound, *found), true);
    std::vector<Recording> recordings = log.fit.bound.recordings;
    recordings[odd->recording] = repaired(log.fit.bound, recordings[odd->recording], found->repairs);
    log.calibrate_again(std::move(recordings));
    odd = find_odd_recording(log.inputs, log.fit);
  }
  if (!odd || log.inputs.stopped()) return;
  std::vector<Recording>& recordings = log.fit.bound.recordings;
  withdraw_jump(log, recordings[odd->recording]);
  log.add({describe_fault(log.fit.bound, *odd)}, log.inputs.may_leave_out);
  if (log.inputs.may_leave_out) recordings.erase(recordings.begin() + static_cast<std::ptrdiff_t>(odd->recording));
}

/// Whether a clock was named before: columns of its recording would bend to it.
SUREFOOT_ONCE bool clock_was_named(const std::vector<LogFault>& named) {
  for (const LogFault& one : named) {
    if (one.kind == name_of(LogFaultKind::offset) || one.kind == name_of(LogFaultKind::time_skew)) return true;
  }
  return false;
}

SUREFOOT_ONCE LogExamination examine_log(const LogDoctorInputs& inputs, const std::vector<Recording>& recordings) {
  LogUnderExamination log{inputs, first_fit(inputs, recordings), {}};
  if (clock_was_named(inputs.named)) examine_clocks(log);
  examine_columns(log);
  examine_readings(log);
  examine_clocks(log);
  examine_odd_recording(log);
  return {std::move(log.faults), std::move(log.fit.bound.recordings), std::move(log.suspected),
          std::move(log.without_suspected)};
}

SUREFOOT_ONCE std::string fault_preface(const std::vector<LogFault>& faults) {
  if (faults.empty()) return "";
  std::size_t left = 0;
  const LogFault* first = nullptr;
  for (const LogFault& fault : faults) {
    if (fault.repaired) continue;
    if (first == nullptr) first = &fault;
    ++left;
  }
  if (left == 0) {
    return "Without a fault of the log (" + faults.front().sentence + (faults.size() > 1 ? ", and others): " : "): ");
  }
  const std::string more = left > 1 ? " (and " + std::to_string(left - 1) + " more)" : "";
  return "Caution, the log has a fault: " + first->sentence + "; " + first->cure + more + ". ";
}

}  // namespace surefoot::diagnosis
