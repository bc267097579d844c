#include "machine.hpp"

#include <algorithm>
#include <cmath>

namespace sparse {
namespace {

using plants::Column;
using plants::Recording;
using plants::System;
using plants::Values;

double constant(const Recording& recording, const std::string& name) {
  for (const auto& [key, value] : recording.meta)
    if (key == name) return value;
  return 0;
}

Machine servo() {
  Machine machine;
  const auto inertia = [](const Values& p, const Recording& r) {
    const double length = constant(r, "length_m");
    return p[2] + constant(r, "mass_kg") * length * length;
  };
  machine.unit = [inertia](const Values& p, const Recording& r) { return 1 / inertia(p, r); };
  machine.model = [inertia](const Values& p, const Recording& r, const Look& at) {
    const double duty = std::clamp(constant(r, "kp") * (at.input[0] - at.state[0]), -1.0, 1.0);
    const double torque = p[0] / p[1] * (constant(r, "vin_V") * duty - p[0] * at.state[1]);
    const double weight = constant(r, "mass_kg") * 9.81 * constant(r, "length_m");
    return Triple{(torque - weight * std::sin(at.state[0])) / inertia(p, r), 0, 0};
  };
  return machine;
}

Machine carriage() {
  Machine machine;
  const auto mass = [](const Values& p, const Recording& r) { return r.meta[0].second > 0 ? r.meta[0].second : p[2]; };
  machine.unit = [mass](const Values& p, const Recording& r) { return 1 / mass(p, r); };
  machine.model = [mass](const Values& p, const Recording& r, const Look& at) {
    return Triple{(at.input[0] - p[0] * at.state[0] - p[1] * at.state[1]) / mass(p, r), 0, 0};
  };
  return machine;
}

Machine tanks() {
  Machine machine;
  machine.motion = Motion::levels;
  machine.components = 2;
  machine.model = [](const Values& p, const Recording&, const Look& at) {
    const double between = p[1] * std::sqrt(std::max(at.state[0], 0.0));
    return Triple{p[0] * at.input[0] - between, between - p[2] * std::sqrt(std::max(at.state[1], 0.0)), 0};
  };
  return machine;
}

Machine walk() {
  Machine machine;
  machine.motion = Motion::walk;
  machine.components = 3;
  machine.model = [](const Values& p, const Recording&, const Look& at) {
    const std::size_t per_axis = p.size() / 3;
    Triple step{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double* own = &p[axis * per_axis];
      if (per_axis == 1) step[axis] = own[0] * at.input[axis];
      if (per_axis == 2) step[axis] = own[0] + own[1] * at.input[axis];
      if (per_axis == 4) step[axis] = own[0] + own[1] * at.input[0] + own[2] * at.input[1] + own[3] * at.input[2];
    }
    return step;
  };
  return machine;
}

Triple with_terms(const Machine& machine, const Values& p, const Values& coefficients, const Recording& recording,
                  const Look& at) {
  Triple value = machine.model(p, recording, at);
  const double unit = machine.unit(p, recording);
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    if (coefficients[k] == 0) continue;
    value[machine.terms[k].component] += unit * coefficients[k] * machine.terms[k].value(at);
  }
  return value;
}

// Rates of the states of a machine in continuous time.
Triple rates(const Machine& machine, const Values& p, const Values& coefficients, const Recording& recording,
             const Look& at) {
  const Triple value = with_terms(machine, p, coefficients, recording, at);
  return machine.motion == Motion::one_dof ? Triple{at.state[1], value[0], 0} : value;
}

Triple next(const Machine& machine, const Values& p, const Values& coefficients, const Recording& recording, Look at,
            double interval) {
  if (machine.motion == Motion::walk) {
    const Triple step = with_terms(machine, p, coefficients, recording, at);
    const double c = std::cos(at.state[2]), s = std::sin(at.state[2]);
    return {at.state[0] + step[0] * c - step[1] * s, at.state[1] + step[0] * s + step[1] * c, at.state[2] + step[2]};
  }
  constexpr int substeps = 2;
  const double h = interval / substeps;
  for (int i = 0; i < substeps; ++i) {
    const Triple start = at.state;
    Triple slopes[4];
    const double shares[4] = {0.5, 0.5, 1, 0};
    for (int k = 0; k < 4; ++k) {
      slopes[k] = rates(machine, p, coefficients, recording, at);
      for (std::size_t j = 0; j < 3; ++j) at.state[j] = start[j] + h * shares[k] * slopes[k][j];
    }
    for (std::size_t j = 0; j < 3; ++j)
      at.state[j] = start[j] + h / 6 * (slopes[0][j] + 2 * slopes[1][j] + 2 * slopes[2][j] + slopes[3][j]);
    at.time += h;
  }
  return at.state;
}

}  // namespace

Machine make_machine(const System& system) {
  Machine machine = system.family == "servo"      ? servo()
                    : system.family == "carriage" ? carriage()
                    : system.family == "tanks"    ? tanks()
                                                  : walk();
  if (!machine.unit) machine.unit = [](const Values&, const Recording&) { return 1.0; };
  for (std::size_t k = 0; k < system.outputs.size(); ++k) machine.output_state.push_back(k);
  if (machine.motion == Motion::levels && system.outputs.size() == 1) machine.output_state = {1};
  return machine;
}

Look look_at(const Machine& machine, const Recording& recording, std::size_t row) {
  Look at;
  at.time = recording.time.empty() ? static_cast<double>(row) : recording.time[row];
  const std::size_t back = machine.motion == Motion::walk ? 1 : 5;
  for (std::size_t k = 0; k < recording.inputs.size(); ++k) {
    at.input[k] = recording.inputs[k][row];
    at.before[k] = recording.inputs[k][row >= back ? row - back : 0];
  }
  return at;
}

std::vector<Column> simulate(const Machine& machine, const Values& parameters, const Values& coefficients,
                             const Recording& recording) {
  Triple state{recording.initial[0], recording.initial[1], recording.initial[2]};
  if (machine.motion != Motion::walk)
    for (std::size_t k = 0; k < machine.output_state.size(); ++k)
      if (!(machine.motion == Motion::one_dof && machine.output_state[k] == 1)) {
        state[machine.output_state[k]] = recording.readings[k][0];
      }
  std::vector<Column> outputs(machine.output_state.size());
  const std::size_t rows = recording.inputs[0].size();
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < outputs.size(); ++k) outputs[k].push_back(state[machine.output_state[k]]);
    if (row + 1 == rows) break;
    Look at = look_at(machine, recording, row);
    at.state = state;
    const double interval = recording.time.empty() ? 1 : recording.time[row + 1] - recording.time[row];
    state = next(machine, parameters, coefficients, recording, at, interval);
    for (double& value : state) value = std::clamp(value, -1e6, 1e6);
  }
  return outputs;
}

}  // namespace sparse
