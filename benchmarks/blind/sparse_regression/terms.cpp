// The libraries of candidate terms, and the effect that each one stands for.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "machine.hpp"

namespace sparse {
namespace {

void force_terms(Machine& machine, bool swings, const Sizes& sizes) {
  const std::string at = swings ? "omega" : "v", order = swings ? "goal" : "force";
  const std::string position = swings ? "theta_rad" : "x_m";
  const double speed = sizes.state[1], reach = sizes.reach[0], slow = 0.05 * speed, creep = 0.2 * speed;
  const auto add = [&](const std::string& effect, const std::string& place, std::function<double(const Look&)> value) {
    machine.terms.push_back({effect, place, 0, std::move(value)});
  };
  add("constant_force", at, [](const Look&) { return 1.0; });
  add("viscous_friction", at, [](const Look& l) { return l.state[1]; });
  add("coulomb_friction", at, [slow](const Look& l) { return std::tanh(l.state[1] / slow); });
  add("stribeck_friction", at, [slow, creep](const Look& l) {
    const double ratio = l.state[1] / creep;
    return std::tanh(l.state[1] / slow) * std::exp(-ratio * ratio);
  });
  add("load_dependent_friction", at,
      [slow](const Look& l) { return std::abs(l.input[0] - l.state[0]) * std::tanh(l.state[1] / slow); });
  add("quadratic_drag", at, [](const Look& l) { return l.state[1] * std::abs(l.state[1]); });
  add("cubic_stiffness", at, [](const Look& l) { return l.state[0] * l.state[0] * l.state[0]; });
  if (swings) add("gravity_offset", at, [](const Look& l) { return std::cos(l.state[0]); });
  for (const double waves : {3.0, 4.5, 6.5}) {
    const double rate = 2 * std::numbers::pi * waves / reach;
    add("cogging", at, [rate](const Look& l) { return std::sin(rate * l.state[0]); });
    add("cogging", at, [rate](const Look& l) { return std::cos(rate * l.state[0]); });
  }
  add("end_stop", at, [reach](const Look& l) { return std::max(l.state[0] - 0.7 * reach, 0.0); });
  add("end_stop", at, [reach](const Look& l) { return std::min(l.state[0] + 0.7 * reach, 0.0); });
  add("input_gain", order, [](const Look& l) { return l.input[0]; });
  add("input_asymmetry", swings ? "duty" : order,
      [swings](const Look& l) { return std::abs(swings ? l.input[0] - l.state[0] : l.input[0]); });
  add("supply_sag", swings ? "duty" : order, [](const Look& l) { return l.input[0] * std::abs(l.input[0]); });
  add("input_delay", order, [](const Look& l) { return l.input[0] - l.before[0]; });
  add("parameter_drift", swings ? "kt" : "stiffness",
      [swings](const Look& l) { return l.time * (swings ? l.input[0] - l.state[0] : l.state[0]); });
  add("sensor_drift", position, [](const Look& l) { return l.time; });
}

void level_terms(Machine& machine, const Sizes& sizes) {
  static const std::vector<std::string> names{"upper", "lower"};
  for (std::size_t tank = 0; tank < 2; ++tank) {
    const double top = sizes.reach[tank];
    const auto add = [&](const std::string& effect, const std::string& place,
                         std::function<double(const Look&)> value) {
      machine.terms.push_back({effect, place, tank, std::move(value)});
    };
    add("constant_rate", names[tank], [](const Look&) { return 1.0; });
    add("leak", names[tank], [tank](const Look& l) { return l.state[tank]; });
    add("overflow", names[tank], [tank, top](const Look& l) { return std::max(l.state[tank] - 0.7 * top, 0.0); });
    add("sensor_drift", names[tank] + "_cm", [](const Look& l) { return l.time; });
    add("parameter_drift", tank == 0 ? "upper_outlet" : "lower_outlet",
        [tank](const Look& l) { return l.time * std::sqrt(std::max(l.state[tank], 0.0)); });
    if (tank == 1) continue;
    const double volts = sizes.reach[0] > 0 ? sizes.input[0] : 1;
    add("supply_sag", "pump", [](const Look& l) { return l.input[0] * l.input[0]; });
    add("saturation", "pump", [volts](const Look& l) { return std::max(l.input[0] - 1.3 * volts, 0.0); });
    add("dead_zone", "pump", [volts](const Look& l) { return std::min(l.input[0], 0.3 * volts); });
    add("input_delay", "pump", [](const Look& l) { return l.input[0] - l.before[0]; });
    add("parameter_drift", "pump_gain", [](const Look& l) { return l.time * l.input[0]; });
  }
}

void walk_terms(Machine& machine, const plants::System& system, const Sizes& sizes) {
  static const std::vector<std::string> axes{"forward", "lateral", "turn"}, orders{"ox", "oy", "ot"};
  const std::size_t per_axis = system.parameters.size() / 3;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double size = sizes.input[axis];
    const auto add = [&](const std::string& effect, const std::string& place,
                         std::function<double(const Look&)> value) {
      machine.terms.push_back({effect, place, axis, std::move(value)});
    };
    if (per_axis == 1) add("body_drift", "body", [](const Look&) { return 1.0; });
    for (std::size_t other = 0; other < 3 && per_axis < 4; ++other)
      if (other != axis) add("cross_coupling", axes[axis], [other](const Look& l) { return l.input[other]; });
    add("input_asymmetry", orders[axis], [axis](const Look& l) { return std::abs(l.input[axis]); });
    add("slip_saturation", axes[axis], [axis](const Look& l) { return std::pow(l.input[axis], 3); });
    add("dead_zone", orders[axis], [axis, size](const Look& l) { return std::tanh(4 * l.input[axis] / size); });
    add("input_delay", orders[axis], [axis](const Look& l) { return l.before[axis] - l.input[axis]; });
    const std::string& gain = system.parameters[axis * per_axis + (per_axis == 1   ? 0
                                                                   : per_axis == 2 ? 1
                                                                                   : 1 + axis)]
                                  .name;
    add("parameter_drift", gain, [axis](const Look& l) { return l.time * l.input[axis]; });
    if (axis == 2) continue;
    // The world's axes seen from the body.
    const double turned = axis == 0 ? 0 : std::numbers::pi / 2;
    add("ground_slope", "world", [turned](const Look& l) { return std::cos(l.state[2] + turned); });
    add("ground_slope", "world", [turned](const Look& l) { return std::sin(l.state[2] + turned); });
  }
}

}  // namespace

void add_terms(Machine& machine, const plants::System& system, const Sizes& sizes) {
  if (machine.motion == Motion::one_dof) force_terms(machine, system.family == "servo", sizes);
  if (machine.motion == Motion::levels) level_terms(machine, sizes);
  if (machine.motion == Motion::walk) walk_terms(machine, system, sizes);
}

}  // namespace sparse
