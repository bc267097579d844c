// An expression of a model file as a tree, so that its names can be checked, parts that stay the same be found, and it
// be written in another language. Grammar, weakest first: c ? a : b, ||, &&, comparisons, + -, * /, unary -, ^ (to the
// right), calls, names, numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace diagnose_program {

/// What is wrong with an expression, with the column in it.
struct ExpressionError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Node {
  enum class Kind : std::uint8_t { number, name, negate, binary, choice, call };
  Kind kind = Kind::number;
  double value = 0;            // of a number
  std::string text;            // name, operator or function
  std::vector<int> arguments;  // nodes
};

struct Expression {
  std::vector<Node> nodes;  // arguments before what uses them
  int root = 0;

  const Node& operator[](int i) const { return nodes[static_cast<std::size_t>(i)]; }
};

/// Throws ExpressionError.
Expression parse_expression(std::string_view text);

/// Names that an expression uses, each once.
std::vector<std::string> names_in(const Expression& expression);

/// A function that expressions may call. One with `most` arguments above `least` is applied from left to right.
struct KnownFunction {
  std::string_view name;
  std::size_t least, most;
};
std::span<const KnownFunction> known_functions();

/// True if a name cannot be given to something of the model: a function, or pi.
bool is_reserved(std::string_view name);

/// True for letters, digits and _ that do not start with a digit.
bool is_identifier(std::string_view name);

/// The shortest text that reads back as the same number.
std::string number_text(double value);

}  // namespace diagnose_program
