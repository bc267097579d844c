// Recordings unlike all others: the model calibrated on the others misses them by far more than any of these.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "surefoot/diagnose/log_doctor/log_fit.hpp"

namespace surefoot::diagnosis {

/// How far a recording is off, in units of the worst other one.
struct OddRecording {
  std::size_t recording = 0;
  double ratio = 1;  // of root mean square errors
};

/// Probability that the logarithm of an error lies so far above those of the others by chance: t tests, on how far the
/// others scatter and on how far they reach above their median. Recordings that happen to be hit well, as few readings
/// are, lie far below and say nothing about how badly one may be missed.
double error_by_chance(const std::vector<double>& errors, std::size_t r);

std::optional<OddRecording> find_odd_recording(const LogDoctorInputs& inputs, const LogFit& logged);

/// What a calibration without recording r leaves of all.
LogFit predicted_without(const LogDoctorInputs& inputs, const LogFit& fit, std::size_t r);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/log_doctor/odd_recording.ipp"
#endif
