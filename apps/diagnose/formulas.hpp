// Several expressions computed by muParser in one go.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "equation_plan.hpp"

namespace mu {
class Parser;
}

namespace diagnose_program {

/// Bound to the memory of `slots`: that must stay where it is.
class Formulas {
 public:
  Formulas();
  Formulas(std::span<const PlanStep> steps, std::span<double> slots);
  Formulas(Formulas&&) noexcept;
  Formulas& operator=(Formulas&&) noexcept;
  ~Formulas();

  /// Computes every step in order. Never throws; results may be NaN or infinite.
  void evaluate() const;

 private:
  std::unique_ptr<mu::Parser> parser_;  // none: nothing to compute
};

}  // namespace diagnose_program
