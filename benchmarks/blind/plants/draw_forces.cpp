#include "draw_forces.hpp"

#include <cmath>
#include <numbers>

namespace plants {
namespace {

// A strength between weak and strong, as a share of something typical.
double graded(Random& random, double low, double high) { return random.log_uniform(low / 3, high); }

Fault blank(const Typical& typical, const std::string& name, Formula formula) {
  Fault fault;
  fault.name = name;
  fault.attached_to = typical.speed_state;
  fault.also = {typical.position_state};
  fault.formula = formula;
  return fault;
}

Fault friction(Random& random, const Typical& typical, const std::string& name, bool same) {
  Fault fault = blank(typical, name, Formula::dry);
  fault.same_formula = same;
  if (name == "coulomb_friction") {
    fault.a = graded(random, 0.06, 0.5) * typical.effort;
    if (!same && random.chance(0.5)) {
      fault.formula = Formula::dry_tanh;
      fault.b = 0.02 * typical.speed;
    }
    fault.numbers = {{"level", fault.a, typical.effort_unit}};
  } else if (name == "stribeck_friction") {
    fault.formula = Formula::stribeck;
    fault.a = graded(random, 0.06, 0.35) * typical.effort;
    fault.b = fault.a * random.uniform(0.5, 1.2);
    fault.c = random.uniform(0.1, 0.4) * typical.speed;
    fault.numbers = {{"level", fault.a, typical.effort_unit},
                     {"extra", fault.b, typical.effort_unit},
                     {"stribeck_speed", fault.c, typical.speed_unit}};
  } else {
    fault.formula = Formula::load_dry;
    fault.a = graded(random, 0.06, 0.3);
    fault.c = same ? 0 : 1;  // in proportion to the drive, or to the load
    fault.numbers = {{"factor", fault.a, "1"}};
  }
  return fault;
}

Fault smooth_force(Random& random, const Typical& typical, const std::string& name, bool same) {
  const std::string& effort = typical.effort_unit;
  Fault fault = blank(typical, name, Formula::viscous);
  fault.same_formula = same;
  if (name == "viscous_friction") {
    fault.same_formula = true;
    fault.a = graded(random, 0.06, 0.6) * typical.effort / typical.speed;
    fault.numbers = {{"coefficient", fault.a, effort + " / (" + typical.speed_unit + ")"}};
  } else if (name == "quadratic_drag") {
    fault.formula = Formula::drag;
    fault.a = graded(random, 0.06, 0.5) * typical.effort / std::pow(typical.speed, same ? 2.0 : 1.8);
    fault.numbers = {{"coefficient", fault.a, effort + " / (" + typical.speed_unit + ")^2"}};
  } else if (name == "constant_force") {
    fault.same_formula = true;
    fault.formula = Formula::constant;
    fault.a = random.sign() * graded(random, 0.05, 0.4) * typical.effort;
    fault.numbers = {{"force", fault.a, effort}};
  } else if (name == "cubic_stiffness") {
    fault.formula = Formula::cubic;
    fault.a = graded(random, 0.08, 0.8) * typical.effort / std::pow(typical.position, 3);
    fault.b = typical.reach;
    fault.numbers = {{"stiffness", fault.a, effort + "/" + typical.position_unit + "^3"}};
  } else if (name == "gravity_offset") {
    fault.same_formula = true;
    fault.formula = Formula::gravity_offset;
    fault.a = random.sign() * graded(random, 0.08, 0.5) * typical.effort;
    fault.numbers = {{"level", fault.a, effort}};
  } else {  // cogging
    fault.formula = same ? Formula::cogging : Formula::cogging_triangle;
    fault.a = graded(random, 0.1, 0.5) * typical.effort;
    fault.b = typical.reach / random.uniform(2.5, 8);
    fault.c = random.uniform(0, 2 * std::numbers::pi);
    fault.numbers = {{"amplitude", fault.a, effort}, {"period", fault.b, typical.position_unit}};
  }
  return fault;
}

Fault memory_force(Random& random, const Typical& typical, const std::string& name, bool same) {
  Fault fault = blank(typical, name, Formula::hysteresis);
  fault.same_formula = same;
  if (name == "hysteresis") {
    if (!same) fault.formula = Formula::hysteresis_square;
    fault.a = graded(random, 0.15, 0.6) * typical.effort;
    fault.b = random.uniform(0.1, 0.4) * typical.position;
    fault.numbers = {{"force", fault.a, typical.effort_unit}, {"yield", fault.b, typical.position_unit}};
  } else if (name == "backlash") {
    fault.formula = same ? Formula::play_seen : Formula::two_mass_play;
    fault.a = graded(random, 0.02, 0.12) * typical.position;
    fault.numbers = {{"half_width", fault.a, typical.position_unit}};
  } else if (name == "joint_elasticity") {
    fault.same_formula = true;
    fault.formula = Formula::elasticity;
    fault.a = graded(random, 0.1, 0.6);
    fault.b = random.uniform(2.5, 8);
    fault.c = random.uniform(0.03, 0.15);
    const double together = std::sqrt(1 + fault.a);  // the two swing against each other faster than the second alone
    fault.numbers = {{"ratio", fault.a, "1"},
                     {"frequency", 2 * std::numbers::pi * fault.b * together, "rad/s"},
                     {"damping", fault.c * together, "1"}};
  } else {  // end_stop
    fault.formula = same ? Formula::stop_hard : Formula::stop_spring;
    fault.b = random.sign();
    fault.a = fault.b * random.uniform(0.5, 0.85) * typical.reach;
    fault.c = random.uniform(0, 0.3);
    fault.numbers = {{"position", fault.a, typical.position_unit}};
  }
  return fault;
}

}  // namespace

Fault draw_force(Random& random, const Typical& typical, const std::string& name) {
  const bool same = random.chance(0.5);
  if (name == "coulomb_friction" || name == "stribeck_friction" || name == "load_dependent_friction") {
    return friction(random, typical, name, same);
  }
  if (name == "hysteresis" || name == "backlash" || name == "joint_elasticity" || name == "end_stop") {
    return memory_force(random, typical, name, same);
  }
  return smooth_force(random, typical, name, same);
}

Fault draw_outside_force(Random& random, const Typical& typical) {
  Fault fault = blank(typical, "outside", Formula::detent);
  fault.same_formula = false;
  const double where = random.uniform(-0.5, 0.5) * typical.reach;
  switch (random.index(6)) {
    case 0:
      fault.name = "outside: magnetic detent near one position";
      fault.a = graded(random, 0.5, 1.5) * typical.effort;
      fault.b = where;
      fault.c = random.uniform(0.05, 0.12) * typical.reach;
      break;
    case 1:
      fault.name = "outside: thick resistance near one position";
      fault.formula = Formula::sticky_patch;
      fault.a = graded(random, 0.8, 4) * typical.effort / typical.speed;
      fault.b = where;
      fault.c = random.uniform(0.08, 0.2) * typical.reach;
      break;
    case 2:
      fault.name = "outside: load that weakens with its own work and recovers";
      fault.formula = Formula::warm_spring;
      fault.a = graded(random, 0.15, 0.5);
      fault.b = typical.speed;
      fault.c = random.uniform(0.5, 1.5);  // [s]
      fault.a /= fault.c;
      break;
    case 3:
      fault.name = "outside: inertia that grows away from the middle";
      fault.formula = Formula::changing_mass;
      fault.a = graded(random, 0.4, 1.5);
      fault.b = random.uniform(0.3, 0.6) * typical.reach;
      fault.c = 0.03 * typical.reach;
      break;
    case 4:
      fault.name = "outside: periodic disturbance in time";
      fault.formula = Formula::gusts;
      fault.a = graded(random, 0.2, 0.8) * typical.effort;
      fault.b = random.uniform(0.3, 1.2);  // [s]
      fault.c = random.uniform(0, 2 * std::numbers::pi);
      break;
    default:
      fault.name = "outside: drive that fades in a stretch of positions";
      fault.formula = Formula::weak_zone;
      fault.a = graded(random, 0.4, 0.9);
      fault.b = where;
      fault.c = random.uniform(0.08, 0.2) * typical.reach;
  }
  return fault;
}

Fault draw_sensor(Random& random, const std::string& name, const std::string& column, const std::string& unit,
                  int output, double spread, double noise, double duration) {
  Fault fault;
  fault.name = name;
  fault.attached_to = column;
  fault.place = Place::sensor;
  fault.target = output;
  fault.same_formula = random.chance(0.5);
  const double size = graded(random, 0.03, 0.2) * spread;
  if (name == "sensor_bias") {
    fault.same_formula = true;
    fault.formula = Formula::bias;
    fault.a = random.sign() * size;
    fault.numbers = {{"bias", fault.a, unit}};
  } else if (name == "sensor_scale") {
    fault.same_formula = true;
    fault.formula = Formula::scale;
    fault.a = random.sign() * graded(random, 0.04, 0.2);
    fault.numbers = {{"error", fault.a, "1"}};
  } else if (name == "sensor_delay") {
    fault.same_formula = true;
    fault.formula = Formula::sensor_delay;
    fault.a = graded(random, 0.004, 0.02) * duration;
    fault.numbers = {{"delay", fault.a, "s"}};
  } else if (name == "sensor_drift") {
    fault.formula = fault.same_formula ? Formula::drift : Formula::drift_warm;
    fault.a = random.sign() * 2 * size / duration;
    fault.b = 0.7 * duration;
    fault.numbers = {{"rate", fault.a, unit + "/s"}};
  } else {  // quantization
    fault.formula = fault.same_formula ? Formula::quantization : Formula::quantization_floor;
    fault.a = noise * graded(random, 4, 15);
    fault.numbers = {{"step", fault.a, unit}};
  }
  return fault;
}

Fault draw_signal(Random& random, const std::string& name, const std::string& attached_to, const std::string& unit,
                  Place place, double size, double top, double time_scale) {
  Fault fault;
  fault.name = name;
  fault.attached_to = attached_to;
  fault.place = place;
  const bool same = random.chance(0.5);
  fault.same_formula = true;
  if (name == "input_gain") {
    fault.formula = Formula::gain;
    fault.a = random.sign() * graded(random, 0.05, 0.25);
    fault.numbers = {{"gain", fault.a, "1"}};
  } else if (name == "input_asymmetry") {
    fault.formula = Formula::asymmetry;
    fault.a = random.sign() * graded(random, 0.04, 0.25);
    fault.numbers = {{"asymmetry", fault.a, "1"}};
  } else if (name == "dead_zone") {
    fault.same_formula = same;
    fault.formula = same ? Formula::dead_soft : Formula::dead_step;
    fault.a = graded(random, 0.05, 0.35) * size;
    fault.numbers = {{"half_width", fault.a, unit}};
  } else if (name == "saturation") {
    fault.same_formula = same;
    fault.formula = same ? Formula::saturation : Formula::saturation_soft;
    fault.a = random.uniform(0.45, 0.85) * top;
    fault.numbers = {{"level", fault.a, unit}};
  } else if (name == "rate_limit") {
    fault.formula = Formula::rate_limit;
    fault.a = random.uniform(0.6, 2.0) * size / time_scale;
    fault.numbers = {{"rate", fault.a, unit + "/s"}};
  } else if (name == "input_delay") {
    fault.formula = Formula::delay;
    fault.a = random.uniform(0.08, 0.4) * time_scale;
    fault.numbers = {{"delay", fault.a, "s"}};
  } else if (name == "first_order_lag") {
    fault.same_formula = same || place == Place::signal;
    fault.formula = fault.same_formula ? Formula::lag : Formula::lag_second;
    fault.a = random.uniform(0.08, 0.5) * time_scale;
    fault.numbers = {{"time_constant", fault.a, "s"}};
  } else {  // supply_sag
    fault.formula = Formula::supply_sag;
    fault.a = graded(random, 0.1, 0.4);
    fault.numbers = {{"sag", fault.a, "1"}};
  }
  return fault;
}

}  // namespace plants
