#include "read_states.hpp"

#include <cmath>
#include <map>
#include <optional>
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

struct Line {
  double offset, slope;
};

// How the expression depends on this state; none where it is not a straight line, or depends on anything else.
std::optional<Line> line_over(const ModelFile& model, const Formula& formula, const std::string& state) {
  constexpr int draws = 3;
  std::optional<Line> line;
  surefoot::Rng rng(1);
  for (int draw = 0; draw < draws; ++draw) {
    std::map<std::string, double> values = some_values(model, rng);
    const auto at = [&](double value) {
      values[state] = value;
      return evaluate_once(formula, values, model.lets);
    };
    const double offset = at(0), slope = at(1) - offset;
    if (same_number(slope, 0) || !same_number(at(-2), offset - 2 * slope)) return std::nullopt;
    if (line && (!same_number(offset, line->offset) || !same_number(slope, line->slope))) return std::nullopt;
    line = line.value_or(Line{offset, slope});
  }
  return line;
}

}  // namespace

ReadState read_state(const ModelFile& model, std::size_t state) {
  const std::string& name = model.states[state].name;
  for (std::size_t k = 0; k < model.outputs.size(); ++k) {
    if (model.outputs[k].value.text == name) return {static_cast<int>(k)};
  }
  for (std::size_t k = 0; k < model.outputs.size(); ++k) {
    try {
      const auto line = line_over(model, model.outputs[k].value, name);
      if (line) return {static_cast<int>(k), line->offset, line->slope};
    } catch (const surefoot::DiagnoseError&) {  // not finite there: no straight line
    }
  }
  return {};
}

}  // namespace diagnose_program
