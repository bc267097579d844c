#include "evaluate_once.hpp"

#include <cmath>

#include "equation_plan.hpp"
#include "formulas.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace diagnose_program {

// As the equations of a model whose only output it is: one way to compute expressions is enough.
double evaluate_once(const Formula& formula, const std::map<std::string, double>& constants,
                     const std::vector<ModelLet>& lets) {
  ModelFile model;
  model.lets = lets;
  for (const auto& [name, value] : constants) model.constants.push_back({name, value, {}});
  model.outputs.push_back({"value", "", formula});
  const EquationPlan plan = plan_equations(model);
  std::vector<double> slots = plan.slots;
  Formulas(plan.prepare, slots).evaluate();
  const double value = slots[static_cast<std::size_t>(plan.outputs.results.front())];
  if (std::isfinite(value)) return value;
  throw surefoot::DiagnoseError(formula.place + ": the value of the expression is not finite");
}

}  // namespace diagnose_program
