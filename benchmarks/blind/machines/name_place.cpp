// Names of the places that effects attach to.
#include <vector>

#include "law_table.hpp"

namespace machines {

void name_place(Hidden& one, const Machine& machine, Where where) {
  const auto t = static_cast<std::size_t>(one.target);
  const auto readers = [&](int state) {
    for (const Output& output : machine.outputs)
      if (output.state == state) one.also.push_back(output.column);
  };
  int group = 0;
  if (where == Where::speed || where == Where::state) {
    one.attached_to = machine.states[t].name;
    if (where == Where::speed) readers(one.target);
    const int position = machine.states[t].position;
    if (position >= 0) one.also.push_back(machine.states[static_cast<std::size_t>(position)].name), readers(position);
  } else if (where == Where::input) {
    one.attached_to = machine.inputs[t].name, group = machine.inputs[t].group;
  } else if (where == Where::signal) {
    one.attached_to = machine.signals[t].name, group = machine.signals[t].group;
  } else if (where == Where::link) {
    one.attached_to = machine.signals[t].name;
    for (const Link& link : machine.links) {
      if (link.signal != one.attached_to) continue;
      for (const int speed : {link.first_speed, link.second_speed}) {
        const State& state = machine.states[static_cast<std::size_t>(speed)];
        one.also.push_back(state.name);
        one.also.push_back(machine.states[static_cast<std::size_t>(state.position)].name);
      }
    }
  } else if (where == Where::sensor) {
    one.attached_to = machine.outputs[t].column;
    one.also.push_back(machine.states[static_cast<std::size_t>(machine.outputs[t].state)].name);
  } else {
    one.attached_to = machine.parameters[t].name;
  }
  for (const Input& input : machine.inputs)
    if (group > 0 && input.group == group) one.multiples.push_back(input.name);
  for (const Signal& signal : machine.signals)
    if (group > 0 && signal.group == group) one.multiples.push_back(signal.name);
  std::erase(one.multiples, one.attached_to);
}

}  // namespace machines
