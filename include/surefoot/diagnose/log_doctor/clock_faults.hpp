// Faults of clocks: recordings whose outputs are late, or whose time runs at another rate, by more than what lags
// differently within and between recordings explains. A delay that all recordings share is physics.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "surefoot/diagnose/log_doctor/clock_estimates.hpp"
#include "surefoot/diagnose/log_doctor/column_faults.hpp"

namespace surefoot::diagnosis {

/// By recording: by how much its clock is off against the others; 0 where it is not.
struct ClockFault {
  LogFaultKind kind = LogFaultKind::offset;
  std::vector<double> amounts;
  bool decisive = true;  // false: more than chance, but no more than physics that is missing might make of it
};

/// Whether recordings of this fit have clocks that can be compared.
bool has_clocks(const LogFit& fit, const LogDoctorCriteria& criteria);

/// Probability that estimates differ like this by chance (an F test of the scatter between recordings against that
/// within them).
double scatter_by_chance(const std::vector<ClockEstimate>& estimates, const LogDoctorCriteria& criteria);

/// Probability that estimate r lies so far from the others by chance: a t test, on its own standard error and on how
/// much further the others scatter than theirs explain, where recordings that the model misses by more scatter more.
double outlier_by_chance(const std::vector<ClockEstimate>& estimates, std::size_t r, const LogDoctorCriteria& criteria);

/// Whether a recording is one of the others at its best clock, or still missed by far more than any: then it is another
/// thing that is wrong with it, or physics that it alone shows.
bool is_like_others(const std::vector<ClockEstimate>& estimates, std::size_t r, const LogDoctorCriteria& criteria);

/// Whether a clock of this rate is off by less than a row at the end of its recording: it passes for no other clock.
bool stays_within_a_row(const Recording& one, double rate);

/// The fault that is most likely; `of_one`: of a single recording, and not offsets that differ between all.
std::optional<ClockFault> find_clock_fault(const LogDoctorInputs& inputs, const LogFit& fit, bool of_one = false);

/// Whether its clock explains a recording better than a fault of its columns: in degrees it would be so small that
/// little can be missed in it.
bool clock_explains_more(const LogDoctorInputs& inputs, const LogFit& fit, const FoundFault& columns);

/// Whether a recording's rate still explains it better if both begin anywhere within the noise of the reading that they
/// begin with: what floats or rolls keeps that error for good, and a rate may make up for some of it.
/// `cured`: recording r, repaired.
bool beats_other_start(const LogDoctorInputs& inputs, const LogFit& fit, std::size_t r, Recording cured);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/clock_faults.ipp"
#endif
