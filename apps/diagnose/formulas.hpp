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

  /// Computes every operation in order. Never throws; results may be NaN or infinite.
  void evaluate() const;

 private:
  struct Bound {
    Operation operation;
    double* to;
    const double *a, *b, *c;
  };
  std::vector<Bound> operations_;
};

}  // namespace diagnose_program
