// Preparation of a diagnosis before it looks for effects: screened recordings, their split, calibrated parameters,
// sizes.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "surefoot/diagnose/options.hpp"
#include "surefoot/diagnose/verdict/investigation.hpp"

namespace all_at_once {

using MakeRig = std::function<surefoot::BoundSimulator(std::vector<surefoot::Recording>)>;

/// Fills bound, split, problem, noise, nominal and selection.nominal (calibrated). Throws surefoot::DiagnoseError for
/// recordings that do not fit the simulator, and for fewer than four.
surefoot::Investigation prepare(const MakeRig& make, const surefoot::SimulatorInfo& info,
                                std::vector<surefoot::Recording> recordings, const surefoot::DiagnoseOptions& options,
                                const surefoot::Parallel& parallel, std::uint64_t seed);

/// Every effect of the options at every place where it fits; none on sensors where each row starts from readings.
std::vector<surefoot::AttachedEffect> candidates(const surefoot::Investigation& investigation,
                                                 const surefoot::DiagnoseOptions& options,
                                                 const surefoot::Parallel& parallel);

}  // namespace all_at_once
