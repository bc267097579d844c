// Faults of readings: sensors that stay at a value while the model moves on, clipped readings, rows that are missing
// or repeat the ones before. What other recordings show as well is the machine, or how its sensors are.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/log_doctor/column_faults.hpp"

namespace surefoot::diagnosis {

/// A stretch of equal readings of an output.
struct ConstantStretch {
  RowRange rows;             // [first, second)
  Eigen::Index readings = 0;  // measured
  double value = 0;
  double missed = 0;   // how much the model moves meanwhile: standard deviation
  bool extreme = false;  // the value is the recording's largest or smallest
  bool beyond = false;   // it is, and the model goes beyond it
};

/// Stretches of at least `constant_rows` equal readings, while the model moves by more than a sensor can tell.
std::vector<ConstantStretch> constant_stretches(const LogFit& fit, std::size_t r, Eigen::Index output,
                                                double resolution, const LogDoctorCriteria& criteria);

/// How many stretches of so many equal readings the short ones lead to expect in a recording: each reading more has the
/// chance that it has in those, as of a coarse sensor in slow motion. `lengths`: of all stretches, from 1 on.
double expected_repeats(const std::vector<double>& lengths, double readings, const LogDoctorCriteria& criteria);

/// The smallest difference between readings that follow each other, over all recordings.
double resolution_of(const std::vector<Recording>& recordings, Eigen::Index output);

/// Intervals without rows, by the rows before them.
std::vector<FoundFault> find_gaps(const BoundSimulator& bound, const LogDoctorCriteria& criteria);

/// Rows that a regular clock left out here and there; 0 where it is not regular. What was commanded in them is lost.
int lost_rows(const Recording& recording);

/// By how much the model must move from row to row, that equal readings of an output are no chance: two steps of its
/// sensor, or four standard deviations of its noise.
double motion_that_shows(const LogFit& fit, Eigen::Index output, double resolution);

/// Stuck sensors, clipped readings and repeated rows.
std::vector<FoundFault> find_reading_faults(const LogFit& fit, const LogDoctorCriteria& criteria);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/reading_faults.ipp"
#endif
