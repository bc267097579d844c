#include "cpp_expression.hpp"

#include <cmath>

namespace diagnose_program {
namespace {

std::string written(const Expression& e, int i) {
  const Node& node = e[i];
  const auto argument = [&](std::size_t k) { return written(e, node.arguments[k]); };
  switch (node.kind) {
    case Node::Kind::number:
      return cpp_number(node.value);
    case Node::Kind::name:
      return "q_" + node.text;
    case Node::Kind::negate:
      return "(-" + argument(0) + ")";
    case Node::Kind::choice:
      return "(" + argument(0) + " != 0 ? " + argument(1) + " : " + argument(2) + ")";
    case Node::Kind::binary:
      if (node.text == "^") return "std::pow(" + argument(0) + ", " + argument(1) + ")";
      if (node.text == "&&" || node.text == "||") {
        return "(" + argument(0) + " != 0 " + node.text + " " + argument(1) + " != 0 ? 1.0 : 0.0)";
      }
      if (node.text == "+" || node.text == "-" || node.text == "*" || node.text == "/") {
        return "(" + argument(0) + " " + node.text + " " + argument(1) + ")";
      }
      return "(" + argument(0) + " " + node.text + " " + argument(1) + " ? 1.0 : 0.0)";
    case Node::Kind::call:
      break;
  }
  if (node.text == "sign") return "sign(" + argument(0) + ")";
  if (node.text == "min" || node.text == "max") {
    std::string folded = argument(0);
    for (std::size_t k = 1; k < node.arguments.size(); ++k) {
      folded = (node.text == "min" ? "smaller(" : "larger(") + folded + ", " + argument(k) + ")";
    }
    return folded;
  }
  if (node.text == "atan2") return "std::atan2(" + argument(0) + ", " + argument(1) + ")";
  return "std::" + node.text + "(" + argument(0) + ")";
}

}  // namespace

std::string cpp_expression(const Expression& expression) { return written(expression, expression.root); }

std::string cpp_number(double value) {
  if (std::isnan(value)) return "std::numeric_limits<double>::quiet_NaN()";
  const std::string text = number_text(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace diagnose_program
