// Repairs of a log: each undoes one fault in one recording.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/diagnose/simulation/bound_simulator.hpp"

namespace surefoot::diagnosis {

enum class LogFaultKind : std::uint8_t {
  sign,         // a channel has the opposite sign
  degrees,      // an angle is in degrees instead of radians, or the other way round
  time_unit,    // milliseconds or finer instead of seconds
  swap,         // two columns are in each other's place
  offset,       // the clock of the outputs is early or late
  output_skew,  // the clock of the outputs is fast or slow
  time_skew,    // the clock of the whole recording is fast or slow
  stuck,        // a sensor stays at a value
  clipped,      // a sensor stays at the end of its range
  repeated,     // rows repeat the ones before
  gap,          // rows are missing
  jump,         // rows are missing, and so is their time
  odd,          // unlike all other recordings
};

/// Name of a kind in results.
std::string name_of(LogFaultKind kind);

/// A column: an input or an output.
struct Channel {
  bool input = false;
  Eigen::Index index = 0;
};

/// Rows [first, second).
using RowRange = std::pair<Eigen::Index, Eigen::Index>;

struct LogRepair {
  LogFaultKind kind = LogFaultKind::sign;
  Channel channel = {}, other = {};  // other: of a swap
  double amount = 1;       // factor of readings or of time; [s] by which outputs are late; clock error as a share
  std::vector<RowRange> rows = {};  // of the channel; those on both sides of a gap
};

/// The recording without that fault; as it is where only the user can cure it (gap, odd).
Recording repaired(const BoundSimulator& bound, const Recording& recording, const LogRepair& repair);

const std::string& name_of(const SimulatorInfo& info, const Channel& channel);
const std::string& unit_of(const SimulatorInfo& info, const Channel& channel);

/// All repairs of columns that may be tried: signs, units of angles, pairs of inputs, of outputs, and of one of each in
/// the same unit.
std::vector<LogRepair> column_repairs(const SimulatorInfo& info);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/log_repair.ipp"
#endif
