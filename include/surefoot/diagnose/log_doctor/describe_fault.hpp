// Faults of a log in words.
#pragma once

#include <string>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/log_doctor/clock_faults.hpp"
#include "surefoot/diagnose/log_doctor/column_faults.hpp"
#include "surefoot/diagnose/log_doctor/odd_recording.hpp"

namespace surefoot::diagnosis {

/// One for each repair: an angle unit may be wrong in several columns.
std::vector<LogFault> describe_fault(const BoundSimulator& bound, const FoundFault& found);

/// One for each recording whose clock is off, or one for all if that is most of them.
std::vector<LogFault> describe_fault(const BoundSimulator& bound, const ClockFault& fault);

LogFault describe_fault(const BoundSimulator& bound, const OddRecording& odd);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/describe_fault.ipp"
#endif
