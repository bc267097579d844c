// Draws the conclusions of an investigation: the verdict, its sentence, what cannot be told apart.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/diagnose/residual_tests/locate.hpp"
#include "surefoot/diagnose/residual_tests/mismatch.hpp"
#include "surefoot/diagnose/residual_tests/noise.hpp"
#include "surefoot/diagnose/residual_tests/predictability.hpp"
#include "surefoot/diagnose/residual_tests/walking/sequence_residual.hpp"
#include "surefoot/diagnose/residual_tests/walking/slip_by_place.hpp"
#include "surefoot/diagnose/text.hpp"
#include "surefoot/diagnose/verdict/describe.hpp"
#include "surefoot/diagnose/verdict/evaluate.hpp"
#include "surefoot/diagnose/verdict/held_out_check.hpp"
#include "surefoot/diagnose/verdict/investigation.hpp"

namespace surefoot::diagnosis {

void locate(Investigation& investigation, const Hypothesis& calibrated, const Parallel& parallel, std::uint64_t seed);

std::string names_of(const Hypothesis& hypothesis);

/// Fills in the diagnosis from what the search found.
void conclude(Investigation& investigation, const std::vector<AttachedEffect>& candidates, const Parallel& parallel,
              std::uint64_t seed);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/verdict.ipp"
#endif
