#include "known_effects.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "names.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace diagnose_program {
namespace {

// What the file says of a parameter; a bare number has no bounds.
surefoot::EffectBounds bounds_of(const surefoot::ParameterInfo& parameter) {
  if (parameter.fixed) return {parameter.value, parameter.value};
  return parameter.low < parameter.high ? surefoot::EffectBounds{parameter.low, parameter.high}
                                        : surefoot::EffectBounds{};
}

// The effect with values and bounds in the order of the library, if the file names exactly the same parameters.
std::optional<surefoot::NamedEffect> in_order(const ModelEffect& effect, const surefoot::Effect& known) {
  if (effect.parameters.size() != known.parameters.size()) return std::nullopt;
  surefoot::NamedEffect result{effect.name, effect.attached_to, effect.form, effect.with};
  for (const surefoot::EffectParameter& wanted : known.parameters) {
    const auto given = std::ranges::find(effect.parameters, wanted.name, &surefoot::ParameterInfo::name);
    if (given == effect.parameters.end()) return std::nullopt;
    result.values.push_back(given->value);
    result.bounds.push_back(bounds_of(*given));
  }
  return result;
}

surefoot::NamedEffect known_effect(const ModelEffect& effect, const std::vector<surefoot::Effect>& library) {
  std::vector<std::string> forms, parameters;
  for (const surefoot::Effect& known : library) {
    if (known.name != effect.name) continue;
    forms.push_back(known.form.empty() ? "no form" : known.form);
    if (known.form != effect.form) continue;
    if (const auto named = in_order(effect, known)) return *named;
    parameters.clear();
    for (const surefoot::EffectParameter& wanted : known.parameters) parameters.push_back(wanted.name);
  }
  const auto fail = [&effect](const std::string& what) { throw surefoot::DiagnoseError(effect.place + ": " + what); };
  if (forms.empty())
    fail("there is no effect " + in_quotes(effect.name) + suggestion(effect.name, names_of_effects(library)));
  if (parameters.empty()) {
    fail("the effect " + in_quotes(effect.name) + " has no form " + in_quotes(effect.form) + "; there is " +
         listed(forms));
  }
  fail("the effect " + in_quotes(effect.name) + " needs the parameters " + listed(parameters) +
       ", all of them and no other");
  return {};
}

}  // namespace

std::vector<std::string> names_of_effects(const std::vector<surefoot::Effect>& library) {
  std::vector<std::string> names;
  for (const surefoot::Effect& effect : library) {
    if (std::ranges::find(names, effect.name) == names.end()) names.push_back(effect.name);
  }
  return names;
}

std::vector<surefoot::NamedEffect> known_effects(const ModelFile& model, const std::vector<surefoot::Effect>& library) {
  std::vector<surefoot::NamedEffect> result;
  for (const ModelEffect& effect : model.effects) result.push_back(known_effect(effect, library));
  return result;
}

}  // namespace diagnose_program
