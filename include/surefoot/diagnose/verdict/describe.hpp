// Describes what was fitted: parameters, effects and how sure each is.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/text.hpp"

namespace surefoot::diagnosis {

std::vector<CalibratedParameter> calibrated_parameters(const BoundSimulator& bound, const Hypothesis& hypothesis,
                                                       const StandardErrors& errors);

std::vector<std::string> correlated_pairs(const BoundSimulator& bound, const StandardErrors& errors);

FoundEffect describe(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t e,
                     const StandardErrors* errors);

/// Share of bootstrap repetitions (over blocks) in which `chosen` beats the parent and every alternative.
double bootstrap_confidence(const EvaluatedHypothesis& chosen, const BlockLosses& parent,
                            const std::vector<EvaluatedHypothesis>& others, std::uint64_t seed);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/describe.ipp"
#endif
