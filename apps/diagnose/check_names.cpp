// Checks of a model file that need all its tables: names, and what expressions refer to.
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "expression.hpp"
#include "model_file.hpp"
#include "names.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace diagnose_program {
namespace {

[[noreturn]] void fail(const std::string& place, const std::string& what) {
  throw surefoot::DiagnoseError(place + ": " + what);
}

using Table = std::map<std::string, std::string>;  // name, and the table it stands in

void add(Table& known, const std::string& file, const std::string& name, const std::string& table) {
  const auto [at, added] = known.emplace(name, table);
  if (added) return;
  fail(file,
       "the name " + in_quotes(name) + " is used twice, in [" + at->second + "] and in [" + table + "]; rename one");
}

Table all_names(const ModelFile& model) {
  Table known;
  for (const auto& input : model.inputs) add(known, model.file, input.name, "inputs");
  for (const auto& state : model.states) add(known, model.file, state.name, "states");
  for (const auto& state : model.states) {
    if (!state.force.empty()) add(known, model.file, state.force, "states." + state.name + ".force");
  }
  for (const auto& constant : model.constants) add(known, model.file, constant.name, "constants");
  for (const auto& parameter : model.parameters) add(known, model.file, parameter.name, "parameters");
  for (const auto& let : model.lets) add(known, model.file, let.name, "let");
  return known;
}

std::vector<std::string> keys(const Table& table) {
  std::vector<std::string> result;
  for (const auto& entry : table) result.push_back(entry.first);
  return result;
}

std::vector<std::string> used_names(const Formula& formula) {
  try {
    return names_in(parse_expression(formula.text));
  } catch (const ExpressionError& error) {
    fail(formula.place, error.what());
  }
}

void check_formula(const Formula& formula, const Table& allowed) {
  for (const std::string& name : used_names(formula)) {
    if (!allowed.contains(name)) {
      fail(formula.place, "the expression uses the unknown name " + in_quotes(name) + suggestion(name, keys(allowed)));
    }
  }
}

// Whether the formula of a let comes to use another one, through as many as there are.
bool leads_to(const ModelFile& model, const std::string& from, const std::string& to, std::set<std::string>& seen) {
  const auto let = std::ranges::find(model.lets, from, &ModelLet::name);
  if (let == model.lets.end() || !seen.insert(from).second) return false;
  return std::ranges::any_of(used_names(let->value),
                             [&](const std::string& name) { return name == to || leads_to(model, name, to, seen); });
}

// A let may use what stands above it.
void check_lets(const ModelFile& model, const Table& known) {
  Table allowed;
  for (const auto& [name, table] : known) {
    if (table != "let") allowed.emplace(name, table);
  }
  for (const ModelLet& let : model.lets) {
    for (const std::string& name : used_names(let.value)) {
      if (name == let.name)
        fail(let.value.place, "the expression uses " + in_quotes(name) + " itself; a let cannot be recursive");
      const auto at = known.find(name);
      std::set<std::string> seen;
      if (leads_to(model, name, let.name, seen)) {
        fail(let.value.place, "the expression uses " + in_quotes(name) + ", which in turn needs " +
                                  in_quotes(let.name) + "; lets cannot go in a circle: make one of them a state");
      }
      if (at != known.end() && !allowed.contains(name)) {
        fail(let.value.place, "the expression uses " + in_quotes(name) + ", which stands further down; move " +
                                  in_quotes(name) + " above " + in_quotes(let.name));
      }
    }
    check_formula(let.value, allowed);
    allowed.emplace(let.name, "let");
  }
}

// Every force moves something.
void check_forces(const ModelFile& model) {
  std::vector<Formula> formulas;
  for (const ModelState& state : model.states) formulas.push_back(state.change);
  for (const ModelLet& let : model.lets) formulas.push_back(let.value);
  for (const ModelState& state : model.states) {
    if (state.force.empty()) continue;
    const bool used = std::ranges::any_of(formulas, [&](const Formula& formula) {
      const std::vector<std::string> names = used_names(formula);
      return std::ranges::find(names, state.force) != names.end();
    });
    if (!used) {
      fail(state.force_place, "no rate uses " + in_quotes(state.force) +
                                  "; add it, as a force that is 0, to the rates that a force on " +
                                  in_quotes(state.name) + " changes");
    }
  }
}

void check_state_name(const ModelFile& model, const std::string& name, const std::string& key) {
  std::vector<std::string> names;
  for (const ModelState& state : model.states) names.push_back(state.name);
  if (std::ranges::find(names, name) != names.end()) return;
  fail(model.file, "[planar] " + key + ": " + in_quotes(name) + " is no state" + suggestion(name, names));
}

void check_planar(const ModelFile& model, const Table& known) {
  if (!model.planar) return;
  const ModelPlanar& planar = *model.planar;
  check_state_name(model, planar.x, "x");
  check_state_name(model, planar.y, "y");
  check_state_name(model, planar.heading, "heading");
  if (planar.x == planar.y || planar.x == planar.heading || planar.y == planar.heading) {
    fail(model.file, "[planar]: x, y and heading must be three different states");
  }
  for (const auto& [key, name] :
       {std::pair{"forward", planar.forward}, {"lateral", planar.lateral}, {"turn", planar.turn}}) {
    if (name.empty()) continue;
    const auto at = known.find(name);
    if (at == known.end() || (at->second != "let" && at->second != "inputs")) {
      fail(model.file, std::string("[planar] ") + key + ": " + in_quotes(name) +
                           " stands neither in [let] nor in [inputs]" + suggestion(name, keys(known)));
    }
  }
}

}  // namespace

void check_names(const ModelFile& model) {
  const Table known = all_names(model);
  Table constants;
  for (const auto& constant : model.constants) constants.emplace(constant.name, "constants");
  check_lets(model, known);
  for (const ModelState& state : model.states) {
    check_formula(state.change, known);
    if (state.effort) check_formula(*state.effort, known);
    if (state.initial == ModelState::Initial::formula) check_formula(state.start, constants);
    if (state.initial == ModelState::Initial::column && model.measured_after_step) {
      fail(state.start.place,
           "measured = \"after step\" knows no measurement before the first step; give a value or \"free\"");
    }
  }
  for (const ModelOutput& output : model.outputs) check_formula(output.value, known);
  check_forces(model);
  check_planar(model, known);
}

}  // namespace diagnose_program
