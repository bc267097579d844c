// The value of an expression over known constants.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "model_file.hpp"

namespace diagnose_program {

/// Throws surefoot::DiagnoseError if the expression is wrong, uses another name, or its value is not finite.
double evaluate_once(const Formula& formula, const std::map<std::string, double>& constants,
                     const std::vector<ModelLet>& lets = {});

}  // namespace diagnose_program
