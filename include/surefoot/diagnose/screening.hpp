// Screening of recordings before anything is fitted: single outliers, channels that never move, time stamps, and what
// is therefore impossible to see.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace surefoot {

/// Throws a DiagnoseError that names recording and channel unless sizes agree, inputs are finite and time rises.
void check_recording(const SimulatorInfo& info, const Recording& recording);

/// Throws a DiagnoseError if there are not three times as many readings, after the first row of each recording, as
/// there are free parameters and initial states, for anything would fit; or if no output ever takes two values.
void check_readings(const SimulatorInfo& info, const std::vector<Recording>& recordings);

/// Takes single outliers out (as not measured) and says so: values beyond and far from both neighbours, which agree.
/// With `simulated` (output x row) these are distances from what a model gives, in which smaller outliers stand out.
std::vector<Remark> remove_outliers(const SimulatorInfo& info, Recording& recording,
                                    const Eigen::MatrixXd& simulated = {});

/// What cannot be seen in these recordings.
std::vector<Remark> screen(const SimulatorInfo& info, const std::vector<Recording>& recordings);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/screening.ipp"
#endif
