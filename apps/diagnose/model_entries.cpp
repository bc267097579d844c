#include "model_entries.hpp"

#include "units.hpp"

namespace diagnose_program {

void check_new_name(const std::string& name, const std::string& where) {
  if (!is_identifier(name)) {
    fail(where, "the name " + in_quotes(name) + " cannot be used in expressions; use letters, digits and _ only");
  }
  if (is_reserved(name)) fail(where, "the name " + in_quotes(name) + " is that of a function; choose another one");
}

void check_count(std::size_t count, const TomlTable& table, const std::string& what, std::size_t most) {
  if (count <= most) return;
  fail(place(table, *table.value),
       std::to_string(count) + " " + what + ", but at most " + std::to_string(most) + " can be diagnosed");
}

ModelInput read_input(const TomlTable& table, const TomlEntry& entry) {
  ModelInput input;
  input.name = entry.key;
  const std::string where = place(table, *entry.value, entry.key);
  check_new_name(entry.key, where);
  if (entry.value->is_string()) {
    input.column = entry.value->as_string().str;
  } else {
    const TomlTable own = sub_table(table, entry, "the name of a column, or { column = ..., hold = \"linear\" },");
    allow_keys(own, {"column", "hold", "unit"});
    input.column = required_text(own, "column", "the column of the recordings");
    if (const toml::value* hold = find(own, "hold")) {
      const std::string text = to_text(*hold, place(own, *hold, "hold"));
      using enum surefoot::InputHold;
      for (const surefoot::InputHold one : {zero_order, linear, before, band_limited}) {
        if (text == surefoot::hold_name(one)) input.hold = one;
      }
      if (!input.hold) {
        fail(place(own, *hold, "hold"), R"("held", "linear", "band-limited" or "before" is expected)");
      }
    }
    if (const toml::value* unit = find(own, "unit")) input.unit = to_text(*unit, place(own, *unit, "unit"));
  }
  if (input.unit.empty()) input.unit = unit_of_column(input.column);
  if (input.unit.empty()) {
    if (input.column.find('_') == std::string::npos) {
      fail(where, "the column " + in_quotes(input.column) + " does not end in its unit; call it like '" +
                      printable(input.column.substr(0, 60)) +
                      "_rad', or for a pure number write { column = ..., unit = \"1\" }");
    }
    input.unit = "1";
    input.assumed = true;
  }
  return input;
}

ModelState read_state(const TomlTable& table, const TomlEntry& entry, bool ode) {
  const TomlTable own = sub_table(
      table, entry, ode ? "{ rate = ..., initial = ..., unit = ... }" : "{ next = ..., initial = ..., unit = ... }");
  const std::string change = ode ? "rate" : "next";
  check_new_name(entry.key, place(table, *entry.value, entry.key));
  if (find(own, ode ? "next" : "rate") != nullptr) {
    fail(place(own, *own.value), ode ? "'next' belongs to kind = \"map\"; an ode has 'rate'"
                                     : "'rate' belongs to kind = \"ode\"; a map has 'next'");
  }
  allow_keys(own, {change, "initial", "unit", "effort", "effort_unit", "force"});
  ModelState state;
  state.name = entry.key;
  const auto formula = [&own](const toml::value& value, const std::string& key) {
    const std::string where = place(own, value, key);
    return Formula{to_formula(value, where), where};
  };
  state.unit = required_text(own, "unit", "its unit, say \"rad\", or \"1\"");
  state.change = formula(
      required(own, change, ode ? "its rate per second, an expression" : "its next value, an expression"), change);
  state.start = formula(required(own, "initial", "a number, an expression, \"column:NAME\" or \"free\""), "initial");
  if (state.start.text == "free") {
    state.initial = ModelState::Initial::free;
  } else if (state.start.text.starts_with("column:")) {
    state.initial = ModelState::Initial::column;
    state.start.text.erase(0, std::string_view("column:").size());
    if (state.start.text.empty()) fail(state.start.place, "the name of a column is expected after 'column:'");
    if (!unit_fits(state.start.text, state.unit)) {
      fail(state.start.place, "the column '" + state.start.text + "' is not in the unit of the state, " + state.unit +
                                  ": name a column that is, or begin with initial = \"free\"");
    }
  }
  const toml::value* effort = find(own, "effort");
  const toml::value* unit = find(own, "effort_unit");
  if (effort != nullptr) state.effort = formula(*effort, "effort");
  if (unit != nullptr) state.effort_unit = to_text(*unit, place(own, *unit, "effort_unit"));
  if (const toml::value* force = find(own, "force")) {
    state.force_place = place(own, *force, "force");
    state.force = to_text(*force, state.force_place);
    check_new_name(state.force, state.force_place);
    if (!ode) fail(state.force_place, "forces act on the velocities of kind = \"ode\"; leave it out of a map");
    if (effort != nullptr) fail(state.force_place, "the rates say what a force does; leave 'effort' out");
    if (unit == nullptr) fail(state.force_place, "'effort_unit', its unit, is missing; say \"N\" or \"N m\"");
  } else if ((effort == nullptr) != (unit == nullptr)) {
    fail(place(own, *own.value), std::string("'effort' and 'effort_unit' belong together; '") +
                                     (effort == nullptr ? "effort" : "effort_unit") + "' is missing");
  }
  return state;
}

/// A standard deviation; NaN where there is none.
double read_deviation(const TomlTable& own, const char* key) {
  const toml::value* value = find(own, key);
  if (value == nullptr) return std::numeric_limits<double>::quiet_NaN();
  const double deviation = to_number(*value, place(own, *value, key));
  if (!(deviation > 0)) fail(place(own, *value, key), "a standard deviation above 0 is expected; or leave it out");
  return deviation;
}

ModelOutput read_output(const TomlTable& table, const TomlEntry& entry, bool ode) {
  const TomlTable own = sub_table(table, entry, "{ value = ..., unit = ... }");
  allow_keys(own, {"value", "unit", "noise", "process_noise"});
  ModelOutput output;
  output.name = entry.key;
  const toml::value& value = required(own, "value", "what the sensor reads, an expression");
  output.value = {to_formula(value, place(own, value, "value")), place(own, value, "value")};
  output.unit = required_text(own, "unit", "its unit, say \"rad\", or \"1\"");
  output.noise = read_deviation(own, "noise");
  output.process_noise = read_deviation(own, "process_noise");
  if (ode && output.process_noise > 0) {
    fail(place(own, *find(own, "process_noise"), "process_noise"),
         "what chance adds in a row is for kind = \"map\" only; 'noise' is that of the sensor");
  }
  if (entry.key.find('_') == std::string::npos && output.unit != "1") {
    fail(place(own, *own.value), "the column " + in_quotes(entry.key) + " does not end in its unit; call it like '" +
                                     printable(entry.key.substr(0, 60)) + "_rad'");
  }
  if (!unit_fits(entry.key, output.unit)) {
    fail(place(own, *own.value), "the column's name ends in " + unit_of_column(entry.key) +
                                     ", but the unit is given as " + in_quotes(output.unit) + "; make them agree");
  }
  return output;
}

ModelConstant read_constant(const TomlTable& table, const TomlEntry& entry) {
  const std::string where = place(table, *entry.value, entry.key);
  check_new_name(entry.key, where);
  if (!entry.value->is_string()) return {entry.key, to_number(*entry.value, where), {}};
  const std::string text = entry.value->as_string().str;
  if (!text.starts_with("meta:") || text == "meta:") fail(where, "a number or \"meta:KEY\" is expected");
  return {entry.key, 0, text.substr(std::string_view("meta:").size())};
}

surefoot::ParameterInfo read_parameter(const TomlTable& table, const TomlEntry& entry) {
  const TomlTable own = sub_table(table, entry, "{ value = ..., min = ..., max = ..., unit = ... }");
  allow_keys(own, {"value", "min", "max", "unit", "fixed"});
  surefoot::ParameterInfo parameter;
  parameter.name = entry.key;
  parameter.value = required_number(own, "value", "its nominal value");
  const toml::value* unit = find(own, "unit");
  parameter.unit = unit != nullptr ? to_text(*unit, place(own, *unit, "unit")) : "1";
  if (const toml::value* fixed = find(own, "fixed")) {
    if (!fixed->is_boolean()) fail(place(own, *fixed, "fixed"), "true or false is expected");
    parameter.fixed = fixed->as_boolean();
  }
  const bool bounds = find(own, "min") != nullptr || find(own, "max") != nullptr;
  if (parameter.fixed && !bounds) {
    parameter.low = parameter.high = parameter.value;
    return parameter;
  }
  parameter.low = required_number(own, "min", "the smallest value it may have");
  parameter.high = required_number(own, "max", "the largest value it may have");
  if (parameter.low > parameter.high) fail(place(own, *own.value), "min is above max; exchange them");
  if (parameter.value < parameter.low || parameter.value > parameter.high) {
    fail(place(own, *own.value), "the value " + number_text(parameter.value) + " lies outside its bounds, " +
                                     number_text(parameter.low) + " to " + number_text(parameter.high) +
                                     "; mend the value or widen the bounds");
  }
  if (!parameter.fixed && parameter.low == parameter.high) {
    fail(place(own, *own.value), "min equals max; write fixed = true for a parameter that is not to be calibrated");
  }
  return parameter;
}

ModelEffect read_effect(const TomlTable& own) {
  allow_keys(own, {"name", "attached_to", "with", "form", "parameters"});
  ModelEffect effect;
  effect.place = place(own, *own.value);
  effect.name = required_text(own, "name", "the name of an effect of the library");
  effect.attached_to = required_text(own, "attached_to", "the state, input, output or parameter");
  if (const toml::value* with = find(own, "with")) effect.with = to_text(*with, place(own, *with, "with"));
  if (const toml::value* form = find(own, "form")) effect.form = to_text(*form, place(own, *form, "form"));
  const toml::value* parameters = find(own, "parameters");
  if (parameters == nullptr) return effect;
  const TomlTable list = sub_table(own, {"parameters", parameters}, "a table of parameters");
  for (const TomlEntry& entry : entries(list)) {
    if (entry.value->is_table()) {
      effect.parameters.push_back(read_parameter(list, entry));
    } else {
      const double value = to_number(*entry.value, place(list, *entry.value, entry.key));
      effect.parameters.push_back({entry.key, "", value, value, value, false});
    }
  }
  check_count(effect.parameters.size(), own, "parameters", most_channels);
  return effect;
}

ModelPlanar read_planar(const TomlTable& table) {
  allow_keys(table, {"x", "y", "heading", "forward", "lateral", "turn"});
  ModelPlanar planar;
  planar.x = required_text(table, "x", "the state that is the position x");
  planar.y = required_text(table, "y", "the state that is the position y");
  planar.heading = required_text(table, "heading", "the state that is the heading");
  for (const auto& [key, member] : {std::pair{"forward", &ModelPlanar::forward},
                                    {"lateral", &ModelPlanar::lateral},
                                    {"turn", &ModelPlanar::turn}}) {
    if (const toml::value* value = find(table, key)) planar.*member = to_text(*value, place(table, *value, key));
  }
  return planar;
}

}  // namespace diagnose_program
