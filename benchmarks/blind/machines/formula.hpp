// Formulas of model files, compiled into steps over registers. The files are written from the same text, so that the
// machine that is simulated and the model that is handed out cannot differ by a slip.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace machines {

/// One operation: registers[to] = operation(registers[a], registers[b]).
struct Step {
  char operation = '+';  // + - * / ^ and letters for functions, see formula.cpp
  int to = 0, a = 0, b = 0;
};

/// Steps in their order, and the register of the result.
struct Formula {
  std::vector<Step> steps;
  int result = 0;
};

/// Names of a model and the registers that hold their values.
class Registers {
 public:
  /// Register of a name, new where it is not known yet.
  int of(const std::string& name);
  /// Register of a name; throws if it is unknown.
  int known(const std::string& name) const;
  int constant(double value);
  int temporary();
  /// What the registers hold before anything is computed.
  const std::vector<double>& initial() const { return values_; }

 private:
  std::map<std::string, int> names_;
  std::vector<double> values_;
};

/// Throws std::invalid_argument if the text is no formula of known names.
Formula compile(std::string_view text, Registers& registers);

void evaluate(const std::vector<Step>& steps, std::span<double> registers);

}  // namespace machines
