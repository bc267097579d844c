// Recordings unlike all others: the model calibrated on the others misses them by far more than any of these.
#pragma once

#include <cstddef>
#include <optional>

#include "surefoot/diagnose/log_doctor/log_fit.hpp"

namespace surefoot::diagnosis {

/// How far a recording is off, in units of the worst other one.
struct OddRecording {
  std::size_t recording = 0;
  double ratio = 1;  // of root mean square errors
};

std::optional<OddRecording> find_odd_recording(const LogDoctorInputs& inputs, const LogFit& logged);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/odd_recording.ipp"
#endif
