#include "known_operations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace diagnose_program {
namespace {

using Unary = double (*)(double);

double sign(double a) { return a > 0 ? 1 : a < 0 ? -1 : a; }

constexpr std::array<std::pair<std::string_view, Operation::Code>, 13> operator_codes{{
    {"+", Operation::Code::add},
    {"-", Operation::Code::subtract},
    {"*", Operation::Code::multiply},
    {"/", Operation::Code::divide},
    {"^", Operation::Code::power},
    {"<", Operation::Code::less},
    {"<=", Operation::Code::less_or_equal},
    {">", Operation::Code::greater},
    {">=", Operation::Code::greater_or_equal},
    {"==", Operation::Code::equal},
    {"!=", Operation::Code::not_equal},
    {"&&", Operation::Code::both},
    {"||", Operation::Code::either},
}};

const std::array<std::pair<std::string_view, Unary>, 16> unary_functions{{
    {"sin", std::sin},
    {"cos", std::cos},
    {"tan", std::tan},
    {"asin", std::asin},
    {"acos", std::acos},
    {"atan", std::atan},
    {"sinh", std::sinh},
    {"cosh", std::cosh},
    {"tanh", std::tanh},
    {"exp", std::exp},
    {"log", std::log},
    {"sqrt", std::sqrt},
    {"abs", std::fabs},
    {"floor", std::floor},
    {"ceil", std::ceil},
    {"sign", sign},
}};

template <class Table>
auto found(const Table& table, std::string_view name) {
  return std::find_if(table.begin(), table.end(), [name](const auto& entry) { return entry.first == name; })->second;
}

}  // namespace

Operation::Code code_of_operator(std::string_view symbol) { return found(operator_codes, symbol); }

Operation call_of(std::string_view function, std::size_t arguments) {
  Operation call;
  if (arguments == 1) {
    call.code = Operation::Code::unary;
    call.unary = found(unary_functions, function);
  } else if (function == "atan2") {
    call.code = Operation::Code::binary;
    call.binary = std::atan2;
  } else {
    call.code = function == "min" ? Operation::Code::smaller : Operation::Code::larger;
  }
  return call;
}

}  // namespace diagnose_program
