// Preparation as in a diagnosis, before it looks for effects: screened recordings, their split, calibrated parameters.
#pragma once

#include <vector>

#include "surefoot/diagnose/verdict/pipeline.hpp"

namespace all_at_once {

/// A calibrated model, and what has been said of the recordings.
struct Prepared {
  surefoot::Diagnosis diagnosis;
  surefoot::diagnosis::EstimationSetup setup;
  surefoot::diagnosis::Calibration calibration;
};

/// Throws surefoot::DiagnoseError for recordings that do not fit the simulator, and for fewer than four.
Prepared prepare(const surefoot::diagnosis::BindSimulator& bind, const surefoot::SimulatorInfo& info,
                 std::vector<surefoot::Recording> recordings, const surefoot::diagnosis::RunContext& run);

}  // namespace all_at_once
