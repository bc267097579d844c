#include "write_augmented.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "expression.hpp"

namespace diagnose_program {
namespace {

// A TOML basic string.
std::string toml_string(const std::string& value) {
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
  return bare ? name : toml_string(name);
}

// A TOML float always has a point or an exponent.
std::string toml_number(double value) {
  const std::string result = number_text(value);
  return result.find_first_of(".e") == std::string::npos ? result + ".0" : result;
}

void write_head(std::ostream& out, const ModelFile& model) {
  out << "schema = \"surefoot.model/1\"\nname = " << toml_string(model.name) << '\n';
  out << "kind = \"" << (model.kind == surefoot::SimulatorKind::ode ? "ode" : "map") << "\"\n";
  if (!model.time.empty()) out << "time = " << toml_string(model.time) << '\n';
  if (!model.sequence.empty()) out << "sequence = " << toml_string(model.sequence) << '\n';
  if (model.skip_rows > 0) out << "skip_rows = " << model.skip_rows << '\n';
  if (model.measured_after_step) out << "measured = \"after step\"\n";
}

void write_states(std::ostream& out, const ModelFile& model) {
  out << "\n[states]\n";
  for (const ModelState& state : model.states) {
    const std::string start =
        state.initial == ModelState::Initial::column ? "column:" + state.start.text : state.start.text;
    out << key(state.name) << (model.kind == surefoot::SimulatorKind::ode ? " = { rate = " : " = { next = ")
        << toml_string(state.change.text) << ", initial = " << toml_string(start)
        << ", unit = " << toml_string(state.unit);
    if (state.effort) {
      out << ", effort = " << toml_string(state.effort->text) << ", effort_unit = " << toml_string(state.effort_unit);
    }
    if (!state.force.empty()) {
      out << ", force = " << toml_string(state.force) << ", effort_unit = " << toml_string(state.effort_unit);
    }
    out << " }\n";
  }
}

void write_parameter(std::ostream& out, const surefoot::ParameterInfo& parameter) {
  out << "{ value = " << toml_number(parameter.value) << ", min = " << toml_number(parameter.low)
      << ", max = " << toml_number(parameter.high) << ", unit = " << toml_string(parameter.unit)
      << (parameter.fixed ? ", fixed = true }" : " }");
}

// Bounds: thrice the interval to either side, wide enough to be fitted again, but of the same sign and within those of
// the search.
surefoot::ParameterInfo effect_parameter(const surefoot::FittedValue& fit) {
  const double interval = std::max(fit.value - fit.low, fit.high - fit.value);
  const double reach = std::max({std::isfinite(interval) ? 3 * interval : 0.0, 0.1 * std::abs(fit.value), 1e-12});
  const double low = fit.value >= 0 ? std::max(0.0, fit.value - reach) : fit.value - reach;
  const double high = fit.value <= 0 ? std::min(0.0, fit.value + reach) : fit.value + reach;
  return {fit.name,
          fit.unit.empty() ? "1" : fit.unit,
          fit.value,
          std::max(low, std::min(fit.least, fit.value)),
          std::min(fit.value == 0 ? reach : high, std::max(fit.most, fit.value)),
          false};
}

void write_effects(std::ostream& out, const ModelFile& model) {
  for (const ModelEffect& effect : model.effects) {
    out << "\n[[effects]]\nname = " << toml_string(effect.name) << "\nattached_to = " << toml_string(effect.attached_to)
        << '\n';
    if (!effect.with.empty()) out << "with = " << toml_string(effect.with) << '\n';
    if (!effect.form.empty()) out << "form = " << toml_string(effect.form) << '\n';
    out << "[effects.parameters]\n";
    for (const surefoot::ParameterInfo& parameter : effect.parameters) {
      out << key(parameter.name) << " = ";
      if (parameter.low < parameter.high) {
        write_parameter(out, parameter);
      } else {
        out << toml_number(parameter.value);
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
    out << key(input.name) << " = { column = " << toml_string(input.column)
        << (input.hold ? ", hold = " + toml_string(std::string(surefoot::hold_name(*input.hold))) : "")
        << ", unit = " << toml_string(input.unit) << " }\n";
  }
  if (!model.lets.empty()) out << "\n[let]\n";
  for (const ModelLet& let : model.lets) out << key(let.name) << " = " << toml_string(let.value.text) << '\n';
  write_states(out, model);
  out << "\n[outputs]\n";
  for (const ModelOutput& output : model.outputs) {
    out << key(output.name) << " = { value = " << toml_string(output.value.text)
        << ", unit = " << toml_string(output.unit);
    if (std::isfinite(output.noise)) out << ", noise = " << toml_number(output.noise);
    if (std::isfinite(output.process_noise)) out << ", process_noise = " << toml_number(output.process_noise);
    out << " }\n";
  }
  if (!model.constants.empty()) out << "\n[constants]\n";
  for (const ModelConstant& constant : model.constants) {
    out << key(constant.name) << " = "
        << (constant.meta.empty() ? toml_number(constant.value) : toml_string("meta:" + constant.meta)) << '\n';
  }
  if (!model.parameters.empty()) out << "\n[parameters]\n";
  for (const surefoot::ParameterInfo& parameter : model.parameters) {
    out << key(parameter.name) << " = ";
    write_parameter(out, parameter);
    out << '\n';
  }
  if (model.planar) {
    const ModelPlanar& planar = *model.planar;
    out << "\n[planar]\nx = " << toml_string(planar.x) << "\ny = " << toml_string(planar.y)
        << "\nheading = " << toml_string(planar.heading) << '\n';
    if (!planar.forward.empty()) out << "forward = " << toml_string(planar.forward) << '\n';
    if (!planar.lateral.empty()) out << "lateral = " << toml_string(planar.lateral) << '\n';
    if (!planar.turn.empty()) out << "turn = " << toml_string(planar.turn) << '\n';
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
  for (std::size_t i = 0; i < std::min(result.inputs.size(), diagnosis.input_holds.size()); ++i) {
    if (model.kind == surefoot::SimulatorKind::ode) result.inputs[i].hold = diagnosis.input_holds[i];
  }
  for (std::size_t i = 0; i < std::min(result.states.size(), diagnosis.freed_states.size()); ++i) {
    if (!diagnosis.freed_states[i]) continue;
    result.states[i].initial = ModelState::Initial::free;
    result.states[i].start.text = "free";
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
