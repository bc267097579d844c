// The result as JSON, schema surefoot.diagnosis/1.
#pragma once

#include <string>

#include "surefoot/diagnose/diagnosis.hpp"

namespace diagnose_program {

/// File of the residual forest, where one is kept.
inline constexpr const char* residual_file = "residual.forest";

/// Numbers that are not finite become null.
std::string diagnosis_json(const surefoot::Diagnosis& diagnosis);

/// "adequate", "parameters-only", "missing-physics" or "unexplained".
std::string verdict_text(surefoot::Verdict verdict);

}  // namespace diagnose_program
