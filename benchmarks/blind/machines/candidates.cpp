// Places where hidden physics may be, and sizes of what happens there.
#include <algorithm>
#include <cmath>

#include "../plants/text.hpp"
#include "draw_effects.hpp"

namespace machines {
namespace {

using plants::words;

void add(std::vector<Candidate>& list, const std::string& names, Where where, std::size_t target) {
  for (const std::string& name : words(names)) list.push_back({name, where, static_cast<int>(target)});
}

void add_forces(std::vector<Candidate>& list, const Machine& machine, std::size_t i) {
  const State& state = machine.states[i];
  add(list, "viscous_friction coulomb_friction stribeck_friction quadratic_drag", Where::speed, i);
  if (!state.effort.empty() || state.position >= 0) add(list, "constant_force", Where::speed, i);
  if (!state.drive.empty()) add(list, "load_dependent_friction", Where::speed, i);
  if (state.position < 0) return;
  add(list, "cubic_stiffness hysteresis backlash joint_elasticity end_stop", Where::speed, i);
  const State& position = machine.states[static_cast<std::size_t>(state.position)];
  add(list, position.unit == "rad" ? "cogging gravity_offset" : "cogging", Where::speed, i);
}

Size size_of(const std::vector<const Column*>& columns, const std::vector<const Column*>& times) {
  Size size;
  double count = 0, sum = 0, squares = 0, rates = 0;
  bool first = true;
  for (std::size_t k = 0; k < columns.size(); ++k)
    for (std::size_t i = 0; i < columns[k]->size(); ++i) {
      const double value = (*columns[k])[i];
      count += 1, sum += value, squares += value * value;
      size.peak = std::max(size.peak, std::abs(value));
      size.low = first ? value : std::min(size.low, value);
      size.high = first ? value : std::max(size.high, value);
      first = false;
      if (i == 0) continue;
      rates += std::pow((value - (*columns[k])[i - 1]) / ((*times[k])[i] - (*times[k])[i - 1]), 2);
    }
  size.rms = std::sqrt(squares / count);
  size.spread = std::sqrt(std::max(squares / count - std::pow(sum / count, 2), 0.0));
  size.rate = std::sqrt(rates / count);
  return size;
}

// Sizes of the columns that `pick` gives for each recording.
template <class Pick>
std::vector<Size> sizes_of(std::size_t count, std::size_t recordings, const std::vector<const Column*>& times,
                           Pick pick) {
  std::vector<Size> sizes;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<const Column*> columns;
    for (std::size_t k = 0; k < recordings; ++k) columns.push_back(&pick(k, i));
    sizes.push_back(size_of(columns, times));
  }
  return sizes;
}

}  // namespace

std::vector<Candidate> named_candidates(const Machine& machine) {
  std::vector<Candidate> list;
  for (std::size_t i = 0; i < machine.states.size(); ++i) {
    const State& state = machine.states[i];
    if (state.is_speed) add_forces(list, machine, i);
    if (state.is_amount)
      add(list, machine.family == "tanks" ? "leak overflow constant_rate" : "constant_rate", Where::state, i);
    if (state.name == "yaw") add(list, "constant_rate", Where::state, i);
  }
  const std::string both = "input_gain dead_zone saturation rate_limit input_delay first_order_lag supply_sag";
  for (std::size_t i = 0; i < machine.inputs.size(); ++i)
    add(list, machine.inputs[i].one_signed ? both : both + " input_asymmetry", Where::input, i);
  for (std::size_t i = 0; i < machine.signals.size(); ++i)
    if (machine.signals[i].driven) add(list, both + " input_asymmetry", Where::signal, i);
  for (const Link& link : machine.links)
    for (std::size_t i = 0; i < machine.signals.size(); ++i)
      if (machine.signals[i].name == link.signal) add(list, "backlash backlash", Where::link, i);
  for (std::size_t i = 0; i < machine.outputs.size(); ++i)
    add(list, "sensor_bias sensor_scale sensor_delay sensor_drift quantization backlash", Where::sensor, i);
  for (std::size_t i = 0; i < machine.parameters.size(); ++i)
    if (!machine.parameters[i].fixed) add(list, "parameter_drift", Where::parameter, i);
  return list;
}

std::vector<Candidate> outside_candidates(const Machine& machine) {
  std::vector<Candidate> list;
  for (std::size_t i = 0; i < machine.states.size(); ++i) {
    const State& state = machine.states[i];
    if (state.is_speed) add(list, "gusts asymmetric_damping heat_fade", Where::speed, i);
    if (state.is_speed && state.position >= 0)
      add(list, "detent sticky_patch growing_inertia weak_zone", Where::speed, i);
    if (state.is_amount)
      add(list, machine.family == "tanks" ? "ripple choke exchange" : "ripple radiation", Where::state, i);
  }
  for (std::size_t i = 0; i < machine.inputs.size(); ++i) add(list, "uneven_gain gain_ripple ageing", Where::input, i);
  return list;
}

Sizes measure(const CompiledMachine& machine, const std::vector<Recording>& recordings) {
  Values actual;
  for (const plants::Parameter& p : machine.machine.parameters) actual.push_back(p.actual);
  std::vector<plants::Series> runs;
  std::vector<const Column*> times;
  Sizes sizes;
  for (const Recording& recording : recordings) {
    runs.push_back(simulate(machine, actual, {}, recording, plants::How{4, false, false, nullptr}, true));
    times.push_back(&recording.time);
    sizes.duration += (recording.time.back() - recording.time.front()) / static_cast<double>(recordings.size());
  }
  const std::size_t states = machine.states.size(), count = recordings.size();
  sizes.states = sizes_of(
      states, count, times, [&](auto k, auto i) -> auto& { return runs[k].states[i]; });
  sizes.signals = sizes_of(
      machine.signals.size(), count, times, [&](auto k, auto i) -> auto& { return runs[k].states[states + i]; });
  sizes.outputs = sizes_of(
      machine.outputs.size(), count, times, [&](auto k, auto i) -> auto& { return runs[k].outputs[i]; });
  sizes.inputs = sizes_of(
      machine.inputs.size(), count, times, [&](auto k, auto i) -> auto& { return recordings[k].inputs[i]; });
  for (std::size_t i = 0; i < states; ++i) {
    std::vector<double> registers = machine.registers;
    for (std::size_t k = 0; k < actual.size(); ++k)
      registers[static_cast<std::size_t>(machine.parameters[k])] = actual[k];
    const Formula& effort = machine.efforts[i];
    evaluate(effort.steps, registers);
    sizes.forces.push_back(sizes.states[i].rate *
                           (effort.result < 0 ? 1 : registers[static_cast<std::size_t>(effort.result)]));
  }
  return sizes;
}

}  // namespace machines
