#include "layout.hpp"

#include <algorithm>

#include "read_states.hpp"
#include "units.hpp"

namespace diagnose_program {
namespace {

template <class Outputs, class Matches>
int find_output(const Outputs& outputs, const Matches& matches) {
  const auto found = std::ranges::find_if(outputs, matches);
  return found == outputs.end() ? -1 : static_cast<int>(found - outputs.begin());
}

// "m/s^2" as the end of a column's name: "m_s2".
std::string column_ending(const std::string& unit) {
  std::string ending;
  for (const char c : unit) {
    if (c == '/' || c == ' ' || c == '.' || c == '*') ending += '_';
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')) ending += c;
  }
  return ending;
}

std::string column_of(const std::string& name, const std::string& unit) {
  const std::string ending = column_ending(unit);
  if (ending.empty() || ending == "1" || name.ends_with("_" + ending)) return name;
  return name + "_" + ending;
}

}  // namespace

Layout layout_of(const ModelFile& model) {
  Layout layout;
  layout.ode = model.kind == surefoot::SimulatorKind::ode;
  layout.time = model.time;
  layout.inputs = model.inputs;
  layout.constants = model.constants;
  layout.sequence = model.sequence;
  layout.skip_rows = model.skip_rows;
  layout.measured_after_step = model.measured_after_step;
  for (const ModelOutput& output : model.outputs) layout.outputs.push_back(output.name);
  std::vector<ReadState> read;
  for (std::size_t i = 0; i < model.states.size(); ++i) read.push_back(read_state(model, i));
  for (std::size_t i = 0; i < model.states.size(); ++i) {
    const ModelState& state = model.states[i];
    StateStart start{state.initial, state.start, read[i], {}, {}};
    start.alike.output = find_output(model.outputs, [&](const ModelOutput& o) { return o.unit == state.unit; });
    for (std::size_t j = 0; j < model.states.size(); ++j) {
      if (layout.ode && model.states[j].change.text == state.name) start.speed_of = read[j];
      if (start.alike.output < 0 && model.states[j].unit == state.unit) start.alike = read[j];
    }
    layout.starts.push_back(start);
  }
  return layout;
}

Layout layout_of(const surefoot::SimulatorInfo& info) {
  Layout layout;
  layout.ode = info.kind == surefoot::SimulatorKind::ode;
  layout.time = layout.ode ? "t_s" : "";
  for (const auto& input : info.inputs) {
    layout.inputs.push_back({input.name, column_of(input.name, input.unit), input.unit, input.hold, false});
  }
  for (const auto& output : info.outputs) layout.outputs.push_back(column_of(output.name, output.unit));
  for (const auto& state : info.states) {
    StateStart start;
    const std::string column = column_of(state.name, state.unit);
    start.measured.output = find_output(layout.outputs, [&](const std::string& name) { return name == column; });
    start.alike.output = find_output(info.outputs, [&](const auto& output) { return output.unit == state.unit; });
    for (std::size_t i = 0; i < info.outputs.size(); ++i) {
      if (layout.ode && state.unit == info.outputs[i].unit + "/s") start.speed_of.output = static_cast<int>(i);
    }
    layout.starts.push_back(start);
  }
  return layout;
}

}  // namespace diagnose_program
