// The log doctor: faults of a log, not of the machine, that would pass for missing physics; named, and repaired.
//
// Each fault is a hypothesis about some recordings: without it the model, calibrated lightly, must miss them decisively
// less, while the others would be missed more. What all recordings share is left to the search for physics. Cost: some
// hundred simulations of each recording.
#pragma once

#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/log_doctor/log_fit.hpp"

namespace surefoot::diagnosis {

struct LogExamination {
  std::vector<LogFault> faults;
  std::vector<Recording> repaired;  // recordings without what could be repaired, and without one unlike all others
  std::vector<LogFault> suspected = {};           // faults that physics that is missing might pass for, or hide
  std::vector<Recording> without_suspected = {};  // `repaired` without these too; empty if there are none
};

LogExamination examine_log(const LogDoctorInputs& inputs, const std::vector<Recording>& recordings);

/// Faults before anything else that is said: a caution, or what was repaired; empty if there is none.
std::string fault_preface(const std::vector<LogFault>& faults);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/examine_log.ipp"
#endif
