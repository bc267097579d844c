// Constant stretches of a sensor's readings: equal ones in a row while the model moves on, and which of them say that
// the sensor was stuck, or clips.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "surefoot/diagnose/log_doctor/column_faults.hpp"

namespace surefoot::diagnosis {

/// A stretch of equal readings of an output.
struct ConstantStretch {
  RowRange rows;              // [first, second)
  Eigen::Index readings = 0;  // measured
  double value = 0;
  double missed = 0;     // how much the model moves meanwhile: standard deviation
  bool extreme = false;  // the value is the recording's largest or smallest
  bool beyond = false;   // it is, and the model goes beyond it
};

/// Stretches of at least `fewest_equal` equal readings, while the model moves by more than a sensor can tell.
std::vector<ConstantStretch> constant_stretches(const LogFit& fit, std::size_t r, Eigen::Index output,
                                                double resolution, const LogDoctorCriteria& criteria);

/// How many stretches of so many equal readings the short ones lead to expect in a recording: each reading more has the
/// chance that it has in those, as of a coarse sensor in slow motion, or at least that of any reading to be equal to
/// the one before. `lengths`: of all stretches, from 1 on.
double expected_repeats(const std::vector<double>& lengths, double readings, double equal_to_the_last,
                        const LogDoctorCriteria& criteria);

/// How many stretches like this one chance makes in a log: each reading that repeats the one before, with the chance of
/// that in other recordings where the model moves no more, and then one that by chance is where the model has gone
/// meanwhile, if steps differ from its by `off`. Infinite if it is not, for a machine that rests goes on from where it
/// was, and at the end of the range, where machines rest. Takes time in proportion to its rows times those of the log.
double expected_by_chance(const LogFit& fit, std::size_t r, Eigen::Index output, const ConstantStretch& stretch,
                          double off);

/// Motion that is missed in all stretches: their squares, summed.
double total_missed(const std::vector<ConstantStretch>& stretches);

/// Lengths of the stretches in which readings are equal, whatever the model does meanwhile; but for those of one value:
/// what clips reads the same whenever it does, which says nothing of chance.
std::vector<double> lengths_of_repeats(const Recording& recording, Eigen::Index output,
                                       double but_for = std::numeric_limits<double>::quiet_NaN());

/// Whether no reading of any output changes within these rows.
bool all_stand_still(const Recording& recording, const std::vector<RowRange>& rows);

/// How far the model moves into a row from the one before; from the reading there, where it begins each step at one.
double step_of_model(const LogFit& fit, std::size_t r, Eigen::Index output, Eigen::Index row);

/// The value that one in twenty exceed.
double high_value(std::vector<double> values);

/// The stretches of one output and recording that no sensor and no machine explains: clipped or stuck. A model that is
/// off moves on where the machine turns, or where it rests; but of more than `natural` equal readings the noise of the
/// sensor would show in some.
std::optional<FoundFault> constant_fault(const LogFit& fit, std::size_t r, Eigen::Index output,
                                         const std::vector<ConstantStretch>& stretches, double natural,
                                         const LogDoctorCriteria& criteria);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/constant_stretches.ipp"
#endif
