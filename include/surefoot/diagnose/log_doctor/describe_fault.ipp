// Definitions of surefoot/diagnose/log_doctor/describe_fault.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/log_doctor/describe_fault.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::string in_short(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

SUREFOOT_ONCE std::string with_unit(double value, const std::string& unit) {
  return in_short(value) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

SUREFOOT_ONCE std::string milliseconds(double seconds) {
  constexpr double in_a_second = 1e3;  // milliseconds
  return in_short(in_a_second * seconds) + " ms";
}

SUREFOOT_ONCE std::string what_is_wrong_in_columns(const SimulatorInfo& info, const LogRepair& repair, bool all) {
  const std::string name = name_of(info, repair.channel);
  switch (repair.kind) {
    case LogFaultKind::sign:
      return name + " has the opposite sign of " + (all ? "what the model expects" : "that in the other recordings");
    case LogFaultKind::degrees:
      return name + (repair.amount < 1 ? " is in degrees where the model expects radians"
                                       : " is in radians where the model expects degrees");
    case LogFaultKind::swap:
      return name + " and " + name_of(info, repair.other) + " are in each other's place";
    default:
      constexpr double milli = 1e-4, micro = 1e-7;  // [s] such a unit is longer
      return "time is in " + std::string(repair.amount > milli ? "milli" : repair.amount > micro ? "micro" : "nano") +
             "seconds where the model expects seconds";
  }
}

SUREFOOT_ONCE std::string what_is_wrong_in_readings(const SimulatorInfo& info, const LogRepair& repair,
                                                    const Recording& recording) {
  const std::string name = name_of(info, repair.channel);
  const RowRange rows = repair.rows.front();
  const double from = recording.time[rows.first], to = recording.time[rows.second - 1];
  const std::string time_unit = info.kind == SimulatorKind::ode ? " s" : "";
  const std::string value =
      with_unit(recording.outputs(repair.channel.index, rows.first), unit_of(info, repair.channel));
  const std::string more = repair.rows.size() > 1 ? " and " + std::to_string(repair.rows.size() - 1) + " more" : "";
  switch (repair.kind) {
    case LogFaultKind::stuck:
      return name + " is stuck at " + value + " from " + in_short(from) + " to " + in_short(to) + time_unit + more +
             ", while the model moves on";
    case LogFaultKind::clipped:
      return name + " is clipped at " + value + ", first from " + in_short(from) + " to " + in_short(to) + time_unit +
             more;
    case LogFaultKind::repeated:
      return std::to_string(repair.rows.size()) + " readings of " + name +
             " repeat the one before, unlike those of other recordings: samples were dropped";
    case LogFaultKind::jump:
      return "all readings jump at " + in_short(recording.time[rows.second]) +
             " s: rows were lost there while the time was counted on";
    default:
      return "rows are missing for " + in_short(recording.time[rows.second] - from) + " s from " + in_short(from) +
             " s on" + more;
  }
}

SUREFOOT_ONCE std::string cure_of(const LogRepair& repair) {
  switch (repair.kind) {
    case LogFaultKind::sign:
      return "flip its sign";
    case LogFaultKind::degrees:
      return "convert it";
    case LogFaultKind::swap:
      return "exchange the two columns";
    case LogFaultKind::time_unit:
      return "convert it to seconds";
    case LogFaultKind::clipped:
      return "leave these readings empty, unless the machine itself goes no further";
    case LogFaultKind::stuck:
    case LogFaultKind::repeated:
      return "leave these readings empty";
    case LogFaultKind::gap:
    case LogFaultKind::jump:
      return "cut the recording there, or record it again";
    case LogFaultKind::offset:
      return "shift the times of its outputs, or log both with one clock";
    default:
      return "rescale its times, or log with one clock";
  }
}

SUREFOOT_ONCE std::vector<LogFault> describe_fault(const BoundSimulator& bound, const FoundFault& found) {
  std::vector<LogFault> faults;
  for (const LogRepair& repair : found.repairs) {
    LogFault fault;
    fault.kind = name_of(repair.kind);
    if (found.recording) fault.recording = bound.recordings[*found.recording].name;
    if (repair.kind != LogFaultKind::time_unit && repair.kind != LogFaultKind::gap &&
        repair.kind != LogFaultKind::jump) {
      fault.channel = name_of(bound.info, repair.channel);
    }
    fault.size = repair.rows.empty() ? repair.amount : static_cast<double>(repair.rows.size());
    const bool in_readings = !repair.rows.empty();
    std::string what = in_readings
                           ? what_is_wrong_in_readings(bound.info, repair, bound.recordings[*found.recording])
                           : what_is_wrong_in_columns(bound.info, repair, !found.recording);
    if (!found.also.empty() && found.repairs.size() == 1) {
      what += " (or " + what_is_wrong_in_columns(bound.info, found.also.front().front(), !found.recording) +
              ", which these recordings cannot tell from it)";
    }
    fault.sentence = (found.recording ? fault.recording : "all recordings") + ": " + what;
    fault.cure = cure_of(repair);
    faults.push_back(std::move(fault));
  }
  return faults;
}

SUREFOOT_ONCE std::string what_is_wrong_with_clock(LogFaultKind kind, double amount) {
  const std::string size = kind == LogFaultKind::offset ? milliseconds(std::abs(amount))
                                                        : in_short(100 * std::abs(amount)) + " %";
  switch (kind) {
    case LogFaultKind::offset:
      return "its outputs are " + size + (amount > 0 ? " later" : " earlier") +
             " against the inputs than those of other recordings";
    case LogFaultKind::output_skew:
      return "the clock of its outputs is " + size + (amount > 0 ? " fast" : " slow") + " against that of the inputs";
    default:
      return "its clock is " + size + (amount > 0 ? " fast" : " slow") + " against those of other recordings";
  }
}

SUREFOOT_ONCE std::vector<LogFault> describe_fault(const BoundSimulator& bound, const ClockFault& clock) {
  std::vector<LogFault> faults;
  double lowest = 0, highest = 0;
  for (std::size_t r = 0; r < clock.amounts.size(); ++r) {
    lowest = std::min(lowest, clock.amounts[r]);
    highest = std::max(highest, clock.amounts[r]);
    if (clock.amounts[r] == 0) continue;
    LogFault fault{.kind = name_of(clock.kind), .recording = bound.recordings[r].name, .size = clock.amounts[r]};
    fault.unit = clock.kind == LogFaultKind::offset ? "s" : "1";
    fault.sentence = fault.recording + ": " + what_is_wrong_with_clock(clock.kind, clock.amounts[r]);
    fault.cure = cure_of({.kind = clock.kind});
    faults.push_back(std::move(fault));
  }
  if (2 * faults.size() <= clock.amounts.size()) return faults;
  std::string each;
  for (const LogFault& one : faults) {
    each += (each.empty() ? "" : ", ") + one.recording + " " + milliseconds(one.size);
  }
  LogFault all{.kind = name_of(clock.kind), .size = highest - lowest, .unit = "s"};
  all.sentence = "all recordings: the clock of the outputs is off against that of the inputs by " +
                 milliseconds(all.size) + " more in some than in others (" + each + ")";
  all.cure = cure_of({.kind = clock.kind});
  return {all};
}

SUREFOOT_ONCE LogFault describe_fault(const BoundSimulator& bound, const OddRecording& odd) {
  LogFault fault{.kind = name_of(LogFaultKind::odd), .recording = bound.recordings[odd.recording].name};
  fault.size = odd.ratio;
  fault.unit = "1";
  fault.sentence = fault.recording + ": is unlike all other recordings; the model calibrated on those is " +
                   in_short(odd.ratio) + " times as far off as on the worst of them";
  fault.cure = "check its constants and what was recorded, or leave it out";
  return fault;
}

}  // namespace surefoot::diagnosis
