#include "machines/formula.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>

namespace {

double value_of(const std::string& text, double x = 0) {
  machines::Registers names;
  const auto at = static_cast<std::size_t>(names.of("x"));
  const machines::Formula formula = machines::compile(text, names);
  std::vector<double> registers = names.initial();
  registers[at] = x;
  machines::evaluate(formula.steps, registers);
  return registers[static_cast<std::size_t>(formula.result)];
}

}  // namespace

TEST_CASE("formulas of model files give what they say") {
  CHECK(value_of("1 + 2*3 - 8/4") == 5);
  CHECK(value_of("-x^2 + (x - 1)*2", 3) == -5);
  CHECK(value_of("min(max(4*x, -1), 1)", -0.5) == -1);
  CHECK(value_of("sqrt(max(x, 0)) + abs(x) + sign(x)", -4) == 3);
  CHECK(value_of("tanh(x)*sin(x) - cos(x)", 0.3) == doctest::Approx(std::tanh(0.3) * std::sin(0.3) - std::cos(0.3)));
}

TEST_CASE("what is no formula is refused") {
  for (const char* wrong : {"1 +", "(x", "y", "sin x", "x x", "unknown(x)", ""})
    CHECK_THROWS_AS(value_of(wrong), std::invalid_argument);
}
