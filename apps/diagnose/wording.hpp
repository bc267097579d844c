// Numbers and lists in words, for the summary and the report.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"

namespace diagnose_program {

/// About `digits` significant digits, without needless zeros: "0.121", "1200", "3.4e-05".
std::string rounded(double value, int digits = 3);

/// 0.714 as "71 %".
std::string percent(double share);

/// "0.121 N m (0.115 to 0.127)".
std::string with_interval(const surefoot::FittedValue& fit);

/// "p = 0.002", "p < 0.001".
std::string p_text(double p);

/// "coulomb_friction at omega + input_delay at goal".
std::string effects_text(const std::vector<std::pair<std::string, std::string>>& effects);

/// A fault of the log with its cure, in one sentence.
std::string fault_text(const surefoot::LogFault& fault);

/// The verdict as a headline: "Physics is missing".
std::string headline(surefoot::Verdict verdict);

}  // namespace diagnose_program
