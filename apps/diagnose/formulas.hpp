// The operations of formulas on the memory that holds their slots.
#pragma once

#include <span>
#include <vector>

#include "equation_plan.hpp"

namespace diagnose_program {

/// Bound to the memory of `slots`: that must stay where it is.
class Formulas {
 public:
  Formulas() = default;

  Formulas(std::span<const Operation> operations, std::span<double> slots);

  /// Of the slots that operations compute, only those `asked` for need hold their values afterwards.
  Formulas(std::span<const Operation> operations, std::span<const int> asked, std::span<double> slots);

  /// Computes every operation in order. Never throws; results may be NaN or infinite.
  void evaluate() const {
    if (!instructions_.empty()) instructions_.front().run(instructions_.data(), 0);
  }

  /// One operation, or two of which the second takes what the first gives. It computes, and runs the next.
  struct Instruction {
    void (*run)(const Instruction*, double last);  // `last`: result of the instruction before
    double* to;
    const double *a, *b, *c;
    double (*unary)(double);
    double (*binary)(double, double);
  };

 private:
  std::vector<Instruction> instructions_;
};

}  // namespace diagnose_program
