// The equations of a model sorted by when they must be computed: what depends on constants and parameters alone once
// per run, the rest in each step, and of that only what is asked for. All quantities live in numbered slots.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "model_file.hpp"

namespace diagnose_program {

/// A value to compute: `slot` where it goes, `text` an expression of muParser over slots v0, v1, ...
struct PlanStep {
  int slot = 0;
  std::string text;
};

/// The quantities of one kind (rates, outputs or efforts), and the lets that they need.
struct PlanPart {
  std::vector<PlanStep> lets;   // in order
  std::vector<int> signals;     // by let: its number among the signals
  std::vector<int> results;     // slots of the results
  std::vector<PlanStep> steps;  // those results that are no mere variable or number
};

struct EquationPlan {
  int states = 0, inputs = 0, parameters = 0;     // slots in this order from 0 on, one each
  std::vector<double> slots;                      // values that never change are in place
  std::vector<std::pair<std::string, int>> meta;  // keys of the recording's first lines, and their slots
  std::vector<PlanStep> prepare;                  // once per set of parameters
  PlanPart change, outputs, efforts;              // rates or next values; sensors; what makes forces of rates
  std::vector<std::string> signals;               // names of those lets that effects may act on
};

/// The model must have passed check_names().
EquationPlan plan_equations(const ModelFile& model);

}  // namespace diagnose_program
