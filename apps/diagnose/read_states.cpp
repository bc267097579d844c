#include "read_states.hpp"

#include <cmath>
#include <cstddef>
#include <map>
#include <string>

#include "evaluate_once.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace diagnose_program {
namespace {

// Some value for everything that the expression of an output may hold.
std::map<std::string, double> some_values(const ModelFile& model, surefoot::Rng& rng) {
  std::map<std::string, double> values;
  for (const ModelState& state : model.states) {
    values[state.name] = rng.uniform();
    if (!state.force.empty()) values[state.force] = rng.uniform();
  }
  for (const ModelInput& input : model.inputs) values[input.name] = rng.uniform();
  for (const ModelConstant& constant : model.constants) {
    values[constant.name] = constant.meta.empty() ? constant.value : rng.uniform();
  }
  for (const surefoot::ParameterInfo& parameter : model.parameters) {
    const double share = parameter.fixed ? 0 : 0.1 * rng.uniform();  // of its range
    values[parameter.name] = parameter.value + share * (parameter.high - parameter.value);
  }
  return values;
}

bool same_number(double a, double b) {
  return std::abs(a - b) <= 1e-9 * (1 + std::abs(a) + std::abs(b));  // but for rounding
}

// How output number `output` reads this state; not at all where it is no straight line, or depends on anything else.
ReadState line_over(const ModelFile& model, int output, const std::string& state) {
  constexpr int draws = 3;
  const Formula& formula = model.outputs[static_cast<std::size_t>(output)].value;
  ReadState line;
  surefoot::Rng rng(1);
  for (int draw = 0; draw < draws; ++draw) {
    std::map<std::string, double> values = some_values(model, rng);
    const auto at = [&](double value) {
      values[state] = value;
      return evaluate_once(formula, values, model.lets);
    };
    const double offset = at(0), slope = at(1) - offset;
    if (same_number(slope, 0) || !same_number(at(-2), offset - 2 * slope)) return {};
    if (draw == 0) line = {output, offset, slope};
    if (!same_number(offset, line.offset) || !same_number(slope, line.slope)) return {};
  }
  return line;
}

}  // namespace

ReadState read_state(const ModelFile& model, std::size_t state) {
  const std::string& name = model.states[state].name;
  const auto outputs = static_cast<int>(model.outputs.size());
  for (int k = 0; k < outputs; ++k) {
    if (model.outputs[static_cast<std::size_t>(k)].value.text == name) return {k};
  }
  for (int k = 0; k < outputs; ++k) {
    try {
      const ReadState line = line_over(model, k, name);
      if (line.output >= 0) return line;
    } catch (const surefoot::DiagnoseError&) {  // not finite there: no straight line
    }
  }
  return {};
}

}  // namespace diagnose_program
