// Preparation of a diagnosis before it looks for effects: screened recordings, their split, calibrated parameters,
// sizes.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/options.hpp"
#include "surefoot/diagnose/verdict/fitted_model.hpp"

namespace all_at_once {

using BindSimulator = std::function<surefoot::diagnosis::BoundSimulator(std::vector<surefoot::Recording>)>;

/// What the stages of this baseline hand on to each other.
struct Preparation {
  surefoot::Diagnosis diagnosis = {};
  surefoot::diagnosis::EstimationSetup setup = {};
  surefoot::diagnosis::Hypothesis nominal = {}, calibrated = {};
};

/// Screens, holds recordings out and calibrates. Throws surefoot::DiagnoseError for recordings that do not fit the
/// simulator, and for fewer than four.
Preparation prepare(const BindSimulator& bind, const surefoot::SimulatorInfo& info,
                    std::vector<surefoot::Recording> recordings, const surefoot::DiagnoseOptions& options,
                    const surefoot::diagnosis::Parallel& parallel, std::uint64_t seed);

/// Every effect of the options at every place where it fits; none on sensors where each row starts from readings.
std::vector<surefoot::AttachedEffect> candidates(const Preparation& prepared, const surefoot::DiagnoseOptions& options,
                                                 const surefoot::diagnosis::Parallel& parallel);

}  // namespace all_at_once
