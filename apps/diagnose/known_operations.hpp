// What an operator or a function of an expression computes.
#pragma once

#include <string_view>

#include "equation_plan.hpp"

namespace diagnose_program {

/// Of "+", "<=", "&&" and so on. The operator must be one of expression.hpp.
Operation::Code code_of_operator(std::string_view symbol);

/// A call of a function with one argument, or with two where `arguments` is above 1. It must be one of expression.hpp.
/// NaN in, NaN out, so that a simulation gone wrong is noticed.
Operation call_of(std::string_view function, std::size_t arguments);

}  // namespace diagnose_program
