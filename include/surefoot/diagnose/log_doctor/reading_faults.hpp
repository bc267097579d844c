// Faults of readings: sensors that stay at a value while the model moves on, clipped readings, rows that are missing
// or repeat the ones before. What other recordings show as well is the machine, or how its sensors are.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/log_doctor/column_faults.hpp"

namespace surefoot::diagnosis {

/// The smallest difference between readings that follow each other, over all recordings.
double resolution_of(const std::vector<Recording>& recordings, Eigen::Index output);

/// Intervals without rows, by the rows before them.
std::vector<FoundFault> find_gaps(const BoundSimulator& bound, const LogDoctorCriteria& criteria);

/// Rows that a regular clock left out here and there; 0 where it is not regular. What was commanded in them is lost.
int lost_rows(const Recording& recording);

/// By how much the model must move from row to row, that equal readings of an output are no chance: two steps of its
/// sensor, or three standard deviations of its noise.
double motion_that_shows(const LogFit& fit, Eigen::Index output, double resolution);

/// Stuck sensors, clipped readings and repeated rows.
std::vector<FoundFault> find_reading_faults(const LogFit& fit, const LogDoctorCriteria& criteria);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/reading_faults.ipp"
#endif
