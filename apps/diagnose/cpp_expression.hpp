// Expressions of model files in C++.
#pragma once

#include <string>

#include "expression.hpp"

namespace diagnose_program {

/// Names get the prefix `q_`, so that none is a keyword. Uses std:: functions, and sign, smaller and larger.
std::string cpp_expression(const Expression& expression);

/// A double literal; NaN as the expression that makes it.
std::string cpp_number(double value);

}  // namespace diagnose_program
