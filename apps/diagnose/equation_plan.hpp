// The equations of a model sorted by when they must be computed: what depends on constants and parameters alone once
// per run, the rest in each step, and of that only what is asked for. All quantities live in numbered slots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "model_file.hpp"

namespace diagnose_program {

/// An operation on the values of slots. Logical values are 1 and 0; what is not 0 is true.
struct Operation {
  enum class Code : std::uint8_t {
    copy,
    negate,
    add,
    subtract,
    multiply,
    divide,
    power,
    less,
    less_or_equal,
    greater,
    greater_or_equal,
    equal,
    not_equal,
    both,
    either,
    smaller,  // of a and b, or NaN
    larger,
    choice,  // b where a is true, else c
    unary,
    binary
  };
  Code code = Code::copy;
  int to = 0, a = 0, b = 0, c = 0;             // slots
  double (*unary)(double) = nullptr;           // a function of a
  double (*binary)(double, double) = nullptr;  // or of a and b
};
using Operations = std::vector<Operation>;

/// A value to compute, and the slot that it goes to.
struct PlanStep {
  int slot = 0;
  Operations operations;
};

/// The quantities of one kind (rates, outputs or efforts), and the lets that they need.
struct PlanPart {
  std::vector<PlanStep> lets;  // in order
  std::vector<int> signals;    // by let: its number among the signals
  std::vector<int> results;    // slots of the results
  Operations operations;       // for those results that are no mere variable or number
};

struct EquationPlan {
  int states = 0, inputs = 0, parameters = 0;     // slots in this order from 0 on, one each
  std::vector<double> slots;                      // values that never change are in place
  int zero = 0;                                   // slot of the number 0
  std::vector<std::pair<std::string, int>> meta;  // keys of the recording's first lines, and their slots
  Operations prepare;                             // once per set of parameters
  PlanPart change, outputs, efforts;              // rates or next values; sensors; what makes forces of rates
  PlanPart responses;                             // by force, by state: what it adds to each rate, per unit
  std::vector<int> pushed;                        // by force: the state that it acts on
  std::vector<std::string> signals;               // names of those lets that effects may act on
};

/// The model must have passed check_names().
EquationPlan plan_equations(const ModelFile& model);

}  // namespace diagnose_program
