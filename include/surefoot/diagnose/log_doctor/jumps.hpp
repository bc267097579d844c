// Jumps of all readings at once: rows that were lost while the times were counted on.
#pragma once

#include <vector>

#include "surefoot/diagnose/log_doctor/column_faults.hpp"

namespace surefoot::diagnosis {

/// Adds recordings with one row into which all readings jump as they do nowhere else, by the rows on both sides: no
/// machine moves so, with positions among its outputs.
void add_jumps(const LogFit& fit, const LogDoctorCriteria& criteria, std::vector<FoundFault>& found);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/jumps.ipp"
#endif
