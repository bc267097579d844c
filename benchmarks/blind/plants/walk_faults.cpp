#include "walk_faults.hpp"

#include <cmath>

#include "draw_forces.hpp"
#include "text.hpp"

namespace plants {
namespace {

Fault planar(const std::string& name, const std::string& attached_to, Formula formula) {
  Fault fault;
  fault.name = name;
  fault.attached_to = attached_to;
  fault.also = {"dx",   "dy",   "dt",           "x",       "y",       "th",   "planar",
                "pose", "step", "displacement", "forward", "lateral", "turn", ""};
  fault.place = Place::planar;
  fault.formula = formula;
  return fault;
}

Fault planar_fault(Random& random, const std::string& name) {
  const std::size_t axis = random.index(3);
  if (name == "slip_saturation") {
    Fault fault = planar(name, axes[axis], Formula::slip);
    fault.same_formula = random.chance(0.6);
    if (!fault.same_formula) fault.formula = Formula::slip_hard;
    fault.target = static_cast<int>(axis);
    fault.a = top_order[axis] * random.uniform(0.45, 1.0);
    fault.numbers = {{"level", fault.a, axis < 2 ? "m" : "rad"}};
    return fault;
  }
  if (name == "body_drift") {
    Fault fault = planar(name, "body", Formula::body_drift);
    const double size = random.log_uniform(0.4, 1.6);
    fault.a = random.sign() * size * random.uniform(0.002, 0.008);
    fault.b = random.sign() * size * random.uniform(0.002, 0.008);
    fault.c = random.sign() * size * random.uniform(0.015, 0.05);
    fault.numbers = {{"forward", fault.a, "m"}, {"lateral", fault.b, "m"}, {"turn", fault.c, "rad"}};
    return fault;
  }
  if (name == "ground_slope") {
    Fault fault = planar(name, "world", random.chance(0.6) ? Formula::slope : Formula::slope_distance);
    const bool steady = fault.formula == Formula::slope;  // else in proportion to the distance walked
    const double angle = random.uniform(-3.14, 3.14);
    const double size = random.log_uniform(0.003, 0.012) / (steady ? 1 : 0.04);
    fault.a = size * std::cos(angle);
    fault.b = size * std::sin(angle);
    fault.numbers = {{"x", fault.a, steady ? "m" : "1"}, {"y", fault.b, steady ? "m" : "1"}};
    return fault;
  }
  Fault fault = planar(name, axes[axis], Formula::coupling);
  const std::size_t from = (axis + 1 + random.index(2)) % 3;
  fault.target = static_cast<int>(axis);
  fault.b = static_cast<double>(from);
  fault.a = random.sign() * random.log_uniform(0.08, 0.4) * top_order[axis] / top_order[from];
  fault.numbers = {{"gain", fault.a, axis == 2 ? "rad/m" : from == 2 ? "m/rad" : "1"}};
  return fault;
}

}  // namespace

Fault draw_walk_fault(Random& random, const System& system) {
  static const std::vector<std::string> names = words(
      "slip_saturation slip_saturation body_drift ground_slope ground_slope cross_coupling cross_coupling "
      "input_asymmetry input_delay dead_zone parameter_drift sensor_bias");
  const std::string name = random.choice(names);
  if (name == "slip_saturation" || name == "body_drift" || name == "ground_slope" || name == "cross_coupling") {
    return planar_fault(random, name);
  }
  const std::size_t axis = random.index(3);
  if (name == "parameter_drift") {
    Fault fault;
    fault.name = name;
    fault.place = Place::parameter;
    fault.formula = Formula::parameter_drift;
    const std::size_t per_axis = system.parameters.size() / 3;
    const std::size_t parameter = per_axis * axis + (per_axis == 1 ? 0 : per_axis == 2 ? 1 : 1 + axis);
    fault.target = static_cast<int>(parameter);
    fault.a = random.sign() * random.uniform(0.008, 0.02);
    fault.attached_to = system.parameters[parameter].name;
    fault.numbers = {{"rate", fault.a, "1/step"}};
    return fault;
  }
  if (name == "sensor_bias") {
    const double size = axis < 2 ? 0.1 : 0.2;
    return draw_sensor(random, name, pose_columns[axis], axis < 2 ? "m" : "rad", static_cast<int>(axis), size, 0, 25);
  }
  Fault fault = draw_signal(random, name, order_names[axis], axis < 2 ? "m" : "rad", Place::input,
                            0.58 * top_order[axis], top_order[axis], 1);
  fault.target = static_cast<int>(axis);
  if (name == "input_delay") {
    fault.a = 1;
    fault.numbers = {{"delay", 1, "step"}};
  }
  fault.also = {std::vector<std::string>{"dx", "dy", "dt"}[axis], axes[axis]};
  return fault;
}

Fault draw_outside_walk_fault(Random& random) {
  Fault fault = planar("", "pose", Formula::stumble);
  fault.same_formula = false;
  switch (random.index(4)) {
    case 0:
      fault.name = "outside: stumble at large combined orders";
      fault.a = random.sign() * random.uniform(0.1, 0.3);
      fault.b = random.uniform(0.9, 1.3);
      break;
    case 1:
      fault.name = "outside: slippery patch of floor";
      fault.formula = Formula::patch;
      fault.a = random.uniform(0.5, 0.95);
      fault.b = random.uniform(0.1, 0.4);
      fault.c = random.uniform(-0.2, 0.2);
      break;
    case 2:
      fault.name = "outside: every third step differs";
      fault.formula = Formula::odd_steps;
      fault.a = random.sign() * random.uniform(0.08, 0.25);
      fault.b = random.uniform(0, 0.5);
      break;
    default:
      fault.name = "outside: twist that depends on the heading, twice per turn";
      fault.formula = Formula::turn_kick;
      fault.a = random.uniform(0.05, 0.15);
      fault.b = random.uniform(0, 6.28);
  }
  return fault;
}

}  // namespace plants
