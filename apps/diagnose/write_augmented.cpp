#include "write_augmented.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "expression.hpp"

namespace diagnose_program {
namespace {

// A TOML basic string.
std::string text(const std::string& value) {
  std::string result = "\"";
  for (const char c : value) {
    constexpr const char* digits = "0123456789ABCDEF";
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (code < 0x20 || code == 0x7F) {
      result += std::string("\\u00") + digits[code / 16] + digits[code % 16];
    } else {
      result += c;
    }
  }
  return result + "\"";
}

// A key: bare where TOML allows it.
std::string key(const std::string& name) {
  const bool bare = !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return bare ? name : text(name);
}

// A TOML float always has a point or an exponent.
std::string number(double value) {
  const std::string result = number_text(value);
  return result.find_first_of(".e") == std::string::npos ? result + ".0" : result;
}

void write_head(std::ostream& out, const ModelFile& model) {
  out << "schema = \"surefoot.model/1\"\nname = " << text(model.name) << '\n';
  out << "kind = \"" << (model.kind == surefoot::SimulatorKind::ode ? "ode" : "map") << "\"\n";
  if (!model.time.empty()) out << "time = " << text(model.time) << '\n';
  if (!model.sequence.empty()) out << "sequence = " << text(model.sequence) << '\n';
  if (model.skip_rows > 0) out << "skip_rows = " << model.skip_rows << '\n';
  if (model.measured_after_step) out << "measured = \"after step\"\n";
}

void write_states(std::ostream& out, const ModelFile& model) {
  out << "\n[states]\n";
  for (const ModelState& state : model.states) {
    const std::string start =
        state.initial == ModelState::Initial::column ? "column:" + state.start.text : state.start.text;
    out << key(state.name) << (model.kind == surefoot::SimulatorKind::ode ? " = { rate = " : " = { next = ")
        << text(state.change.text) << ", initial = " << text(start) << ", unit = " << text(state.unit);
    if (state.effort) {
      out << ", effort = " << text(state.effort->text) << ", effort_unit = " << text(state.effort_unit);
    }
    out << " }\n";
  }
}

void write_parameter(std::ostream& out, const surefoot::ParameterInfo& parameter) {
  out << "{ value = " << number(parameter.value) << ", min = " << number(parameter.low)
      << ", max = " << number(parameter.high) << ", unit = " << text(parameter.unit)
      << (parameter.fixed ? ", fixed = true }" : " }");
}

// Bounds: thrice the interval to either side, wide enough to be fitted again.
surefoot::ParameterInfo effect_parameter(const surefoot::FittedValue& fit) {
  const double interval = std::max(fit.value - fit.low, fit.high - fit.value);
  const double reach = std::max({std::isfinite(interval) ? 3 * interval : 0.0, 0.1 * std::abs(fit.value), 1e-12});
  return {fit.name, fit.unit.empty() ? "1" : fit.unit, fit.value, fit.value - reach, fit.value + reach, false};
}

void write_effects(std::ostream& out, const ModelFile& model) {
  for (const ModelEffect& effect : model.effects) {
    out << "\n[[effects]]\nname = " << text(effect.name) << "\nattached_to = " << text(effect.attached_to) << '\n';
    if (!effect.with.empty()) out << "with = " << text(effect.with) << '\n';
    if (!effect.form.empty()) out << "form = " << text(effect.form) << '\n';
    out << "[effects.parameters]\n";
    for (const surefoot::ParameterInfo& parameter : effect.parameters) {
      out << key(parameter.name) << " = ";
      if (parameter.low < parameter.high) {
        write_parameter(out, parameter);
      } else {
        out << number(parameter.value);
      }
      out << '\n';
    }
  }
}

}  // namespace

std::string model_text(const ModelFile& model) {
  std::ostringstream out;
  write_head(out, model);
  if (!model.inputs.empty()) out << "\n[inputs]\n";
  for (const ModelInput& input : model.inputs) {
    out << key(input.name) << " = { column = " << text(input.column) << (input.linear ? ", hold = \"linear\"" : "")
        << ", unit = " << text(input.unit) << " }\n";
  }
  if (!model.lets.empty()) out << "\n[let]\n";
  for (const ModelLet& let : model.lets) out << key(let.name) << " = " << text(let.value.text) << '\n';
  write_states(out, model);
  out << "\n[outputs]\n";
  for (const ModelOutput& output : model.outputs) {
    out << key(output.name) << " = { value = " << text(output.value.text) << ", unit = " << text(output.unit);
    if (std::isfinite(output.noise)) out << ", noise = " << number(output.noise);
    out << " }\n";
  }
  if (!model.constants.empty()) out << "\n[constants]\n";
  for (const ModelConstant& constant : model.constants) {
    out << key(constant.name) << " = "
        << (constant.meta.empty() ? number(constant.value) : text("meta:" + constant.meta)) << '\n';
  }
  if (!model.parameters.empty()) out << "\n[parameters]\n";
  for (const surefoot::ParameterInfo& parameter : model.parameters) {
    out << key(parameter.name) << " = ";
    write_parameter(out, parameter);
    out << '\n';
  }
  if (model.planar) {
    const ModelPlanar& planar = *model.planar;
    out << "\n[planar]\nx = " << text(planar.x) << "\ny = " << text(planar.y) << "\nheading = " << text(planar.heading)
        << '\n';
    if (!planar.forward.empty()) out << "forward = " << text(planar.forward) << '\n';
    if (!planar.lateral.empty()) out << "lateral = " << text(planar.lateral) << '\n';
    if (!planar.turn.empty()) out << "turn = " << text(planar.turn) << '\n';
  }
  write_effects(out, model);
  return out.str();
}

ModelFile augmented_model(const ModelFile& model, const surefoot::Diagnosis& diagnosis) {
  ModelFile result = model;
  const auto& fitted = diagnosis.augmented_parameters.empty() ? diagnosis.parameters : diagnosis.augmented_parameters;
  for (surefoot::ParameterInfo& parameter : result.parameters) {
    for (const auto& calibrated : fitted) {
      if (calibrated.fit.name != parameter.name || parameter.fixed || !std::isfinite(calibrated.fit.value)) continue;
      parameter.value = std::clamp(calibrated.fit.value, parameter.low, parameter.high);
    }
  }
  for (std::size_t i = 0; i < std::min(result.effects.size(), diagnosis.known_effects.size()); ++i) {
    for (surefoot::ParameterInfo& parameter : result.effects[i].parameters) {
      for (const auto& fit : diagnosis.known_effects[i].parameters) {
        if (fit.name == parameter.name && std::isfinite(fit.value)) parameter = effect_parameter(fit);
      }
    }
  }
  for (const auto& found : diagnosis.effects) {
    ModelEffect effect{found.name, found.attached_to, found.other, found.form, {}, {}};
    for (const auto& fit : found.parameters) effect.parameters.push_back(effect_parameter(fit));
    result.effects.push_back(std::move(effect));
  }
  return result;
}

}  // namespace diagnose_program
