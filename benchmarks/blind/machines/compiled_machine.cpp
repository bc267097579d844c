// Formulas of a machine, made ready.
#include "simulate.hpp"

namespace machines {

CompiledMachine::CompiledMachine(const Machine& description) : machine(description) {
  Registers names;
  names.constant(0);
  for (const Input& one : machine.inputs) inputs.push_back(names.of(one.name));
  for (const State& one : machine.states) states.push_back(names.of(one.name));
  for (const Constant& one : machine.constants) constants.push_back(names.of(one.name));
  for (const plants::Parameter& one : machine.parameters) parameters.push_back(names.of(one.name));
  for (const Signal& one : machine.signals) {
    signal_formulas.push_back(compile(one.formula, names));
    signals.push_back(names.of(one.name));
  }
  for (const State& one : machine.states) {
    rates.push_back(compile(one.rate, names));
    efforts.push_back(one.effort.empty() ? Formula{{}, -1} : compile(one.effort, names));
    drives.push_back(one.drive.empty() ? -1 : names.known(one.drive));
    loads.push_back(one.load.empty() ? -1 : names.known(one.load));
  }
  for (const Output& one : machine.outputs) outputs.push_back(compile(one.formula, names));
  registers = names.initial();
}

}  // namespace machines
