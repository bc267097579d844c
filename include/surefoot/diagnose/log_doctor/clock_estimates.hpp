// Estimates of each recording's clock: how late its outputs are, how fast the clock of its outputs or of the whole
// recording is; with standard errors.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "surefoot/diagnose/log_doctor/log_fit.hpp"
#include "surefoot/diagnose/log_doctor/log_repair.hpp"

namespace surefoot::diagnosis {

/// Mean square residual of one recording, in units of what is typically left, by what its clock might be off.
struct ClockProfile {
  std::vector<double> amounts;  // ascending; evenly spaced where no more than reading at other times is needed
  Eigen::MatrixXd squares;      // block of rows x amount: sums; physics that is missing lags differently in each block
  Eigen::MatrixXd counts;
};

struct ClockEstimate {
  bool usable = false;  // the error has a minimum within the range
  double value = 0;     // [s], or a share of the time
  double variance = 0;  // by leaving out each block in turn (jackknife): what lags differently within a recording
  double error = 0;     // mean square there
};

/// Kind: offset, output_skew or time_skew.
ClockProfile clock_profile(const LogFit& fit, std::size_t r, LogFaultKind kind, const LogDoctorCriteria& criteria);

ClockEstimate clock_estimate(const ClockProfile& profile);

/// Mean square error at an amount between those that were tried.
double error_at(const ClockProfile& profile, double amount);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/clock_estimates.ipp"
#endif
