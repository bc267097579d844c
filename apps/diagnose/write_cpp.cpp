#include "write_cpp.hpp"

#include <algorithm>
#include <set>
#include <sstream>
#include <vector>

#include "cpp_expression.hpp"
#include "equation_plan.hpp"

namespace diagnose_program {
namespace {

// A string literal. Other bytes than printable ASCII go as octal numbers.
std::string string_literal(const std::string& value) {
  std::string result = "\"";
  for (const char c : value) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\' || c == '?' || code < 0x20 || code >= 0x7F) {
      result += '\\';
      for (const int shift : {6, 3, 0}) result += static_cast<char>('0' + ((code >> shift) & 7));
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string one_line(std::string value) {
  std::ranges::replace_if(
      value, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\\'; }, '?');
  return value;
}

std::string hold_value(surefoot::InputHold hold) {
  std::string name(surefoot::hold_name(hold));
  if (hold == surefoot::InputHold::zero_order) name = "zero_order";  // a model file calls these otherwise
  if (hold == surefoot::InputHold::band_limited) name = "band_limited";
  return "surefoot::InputHold::" + name;
}

void write_info(std::ostream& out, const ModelFile& model, const EquationPlan& plan) {
  out << "  surefoot::SimulatorInfo info() const {\n    surefoot::SimulatorInfo info;\n    info.name = "
      << string_literal(model.name)
      << ";\n    info.kind = surefoot::SimulatorKind::" << (model.kind == surefoot::SimulatorKind::ode ? "ode" : "map")
      << ";\n    info.states = {";
  for (const auto& state : model.states) {
    out << "{" << string_literal(state.name) << ", " << string_literal(state.unit) << ", "
        << string_literal(state.effort_unit) << "}, ";
  }
  out << "};\n    info.inputs = {";
  for (const auto& input : model.inputs) {
    out << "{" << string_literal(input.name) << ", " << string_literal(input.unit) << ", "
        << (input.hold ? hold_value(*input.hold) : "{}") << "}, ";
  }
  out << "};\n    info.outputs = {";
  for (const auto& output : model.outputs) {
    out << "{" << string_literal(output.name) << ", " << string_literal(output.unit) << ", " << cpp_number(output.noise)
        << ", " << cpp_number(output.process_noise) << "}, ";
  }
  out << "};\n    info.parameters = {";
  for (const auto& parameter : model.parameters) {
    out << "{" << string_literal(parameter.name) << ", " << string_literal(parameter.unit) << ", "
        << cpp_number(parameter.value) << ", " << cpp_number(parameter.low) << ", " << cpp_number(parameter.high)
        << ", " << (parameter.fixed ? "true" : "false") << "}, ";
  }
  out << "};\n    info.signals = {";
  for (const std::string& signal : plan.signals) out << string_literal(signal) << ", ";
  out << "};\n";
  if (model.planar) {
    const auto index = [&](const std::string& name) {
      return std::ranges::find(model.states, name, &ModelState::name) - model.states.begin();
    };
    out << "    info.planar = surefoot::PlanarInfo{" << index(model.planar->x) << ", " << index(model.planar->y) << ", "
        << index(model.planar->heading) << "};\n";
  }
  out << "    return info;\n  }\n\n";
}

void write_constants(std::ostream& out, const ModelFile& model) {
  for (const auto& constant : model.constants) {
    out << "  double q_" << constant.name << " = " << cpp_number(constant.value) << ";"
        << (constant.meta.empty() ? "" : "  // of each recording") << '\n';
  }
  out << "\n  Model for_recording([[maybe_unused]] const surefoot::Recording& recording) const {\n    Model model = "
         "*this;\n";
  for (const auto& constant : model.constants) {
    if (constant.meta.empty()) continue;
    out << "    model.q_" << constant.name << " = recording.constants.at(" << string_literal(constant.meta) << ");\n";
  }
  out << "    return model;\n  }\n\n";
}

// What the formulas use, by way of lets too.
std::set<std::string> used_by(const ModelFile& model, const std::vector<Formula>& formulas) {
  std::set<std::string> used;
  const auto add = [&used](const Formula& formula) {
    for (const std::string& name : names_in(parse_expression(formula.text))) used.insert(name);
  };
  for (const Formula& formula : formulas) add(formula);
  for (std::size_t i = model.lets.size(); i-- > 0;) {
    if (used.contains(model.lets[i].name)) add(model.lets[i].value);
  }
  return used;
}

// The body of a function that gives these formulas; signals go through a tap where `signals` is not empty, and forces
// act where it is `pushed`.
void write_body(std::ostream& out, const ModelFile& model, const std::vector<Formula>& formulas,
                const std::string& type, const std::vector<std::string>& signals, bool pushed = false) {
  const std::set<std::string> used = used_by(model, formulas);
  const auto read = [&](const auto& items, const char* from) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (used.contains(items[i].name))
        out << "    const double q_" << items[i].name << " = " << from << "[" << i << "];\n";
    }
  };
  read(model.states, "x");
  read(model.inputs, "u");
  read(model.parameters, "p");
  for (std::size_t i = 0; i < model.states.size(); ++i) {
    const std::string& force = model.states[i].force;
    if (!used.contains(force)) continue;
    out << "    const double q_" << force << " = " << (pushed ? "forces[" + std::to_string(i) + "]" : "0") << ";\n";
  }
  for (const ModelLet& let : model.lets) {
    if (!used.contains(let.name)) continue;
    const std::string value = cpp_expression(parse_expression(let.value.text));
    const auto signal = std::ranges::find(signals, let.name);
    out << "    const double q_" << let.name << " = ";
    if (signal == signals.end()) {
      out << value << ";\n";
    } else {
      out << "tap(" << signal - signals.begin() << ", " << value << ");\n";
    }
  }
  out << "    " << type << " result;\n";
  for (std::size_t i = 0; i < formulas.size(); ++i) {
    out << "    result[" << i << "] = " << cpp_expression(parse_expression(formulas[i].text)) << ";\n";
  }
  out << "    return result;\n  }\n\n";
}

void write_equations(std::ostream& out, const ModelFile& model, const EquationPlan& plan) {
  const bool ode = model.kind == surefoot::SimulatorKind::ode;
  const std::string change = ode ? "derivative" : "next";
  const std::string arguments =
      "[[maybe_unused]] const State& x, [[maybe_unused]] const Input& u, [[maybe_unused]] const Eigen::VectorXd& p";
  std::vector<Formula> changes, efforts, outputs;
  for (const ModelState& state : model.states) {
    changes.push_back(state.change);
    efforts.push_back(state.effort ? *state.effort : Formula{"1", ""});
  }
  for (const ModelOutput& output : model.outputs) outputs.push_back(output.value);
  const bool pushed = std::ranges::any_of(model.states, [](const ModelState& state) { return !state.force.empty(); });
  const std::string with_tap = "  template <class Tap>\n  State " + change + "(" + arguments + ", ";
  if (pushed) {
    out << "  /// Rates under forces on the states.\n  template <class Tap>\n  State pushed(" << arguments
        << ", const State& forces, [[maybe_unused]] Tap&& tap) const {\n";
    write_body(out, model, changes, "State", plan.signals, pushed);
    out << with_tap << "Tap&& tap) const {\n    return pushed(x, u, p, State::Zero(), tap);\n  }\n"
        << "  State response(" << arguments << ", const State& forces) const {\n"
        << "    return pushed(x, u, p, forces, surefoot::NoTap{}) - derivative(x, u, p);\n  }\n";
  } else {
    out << with_tap << "[[maybe_unused]] Tap&& tap) const {\n";
    write_body(out, model, changes, "State", plan.signals);
  }
  out << "  State " << change << "(const State& x, const Input& u, const Eigen::VectorXd& p) const {\n    return "
      << change << "(x, u, p, surefoot::NoTap{});\n  }\n\n";
  if (ode) {
    out << "  State effort(" << arguments << ") const {\n";
    write_body(out, model, efforts, "State", {});
  }
  out << "  Output observe(" << arguments << ") const {\n";
  write_body(out, model, outputs, "Output", {});
}

void write_found(std::ostream& out, const ModelFile& model, const surefoot::Diagnosis& diagnosis) {
  out << "/// What was found: calibrated parameters, effects, and the integration that all this was simulated with.\n"
         "inline surefoot::Augmented found() {\n  surefoot::Augmented found;\n  found.parameters = {";
  for (const auto& parameter : model.parameters) out << cpp_number(parameter.value) << ", ";
  out << "};\n";
  for (const ModelEffect& effect : model.effects) {
    out << "  found.effects.push_back({" << string_literal(effect.name) << ", " << string_literal(effect.attached_to)
        << ", " << string_literal(effect.form) << ", " << string_literal(effect.with) << ", {";
    for (const auto& parameter : effect.parameters) out << cpp_number(parameter.value) << ", ";
    out << "}});\n";
  }
  out << "  found.integration.order = " << diagnosis.integration_order
      << ";\n  found.integration.step = " << cpp_number(diagnosis.integration_step)
      << ";  // [s], 0: that of the rows\n"
      << "  return found;\n}\n";
}

}  // namespace

std::string model_header(const ModelFile& model, const surefoot::Diagnosis& diagnosis) {
  const EquationPlan plan = plan_equations(model);
  std::ostringstream out;
  out << "// " << one_line(model.name)
      << ": its equations and what a diagnosis found, written by surefoot-diagnose for the library surefoot.\n"
         "//\n//   surefoot::simulate_augmented(augmented::Model{}, augmented::found(), recording)\n"
         "#pragma once\n\n#include <Eigen/Core>\n#include <cmath>\n#include <limits>\n\n"
         "#include \"surefoot/core/vec.hpp\"\n#include \"surefoot/diagnose/simulate_augmented.hpp\"\n\nnamespace "
         "augmented {\n\n"
         "inline double smaller(double a, double b) { return a < b || a != a ? a : b; }\n"
         "inline double larger(double a, double b) { return a > b || a != a ? a : b; }\n"
         "inline double sign(double a) { return a > 0 ? 1 : a < 0 ? -1 : a; }\n\nstruct Model {\n";
  out << "  using State = surefoot::Vec<" << model.states.size() << ">;\n  using Input = surefoot::Vec<"
      << model.inputs.size() << ">;\n  using Output = surefoot::Vec<" << model.outputs.size() << ">;\n\n";
  write_constants(out, model);
  write_info(out, model, plan);
  write_equations(out, model, plan);
  out << "};\nstatic_assert(surefoot::Simulator<Model>);\n\n";
  write_found(out, model, diagnosis);
  out << "\n}  // namespace augmented\n";
  return out.str();
}

}  // namespace diagnose_program
