// Drives of first-order speed, vertical lifts and wheeled rovers.
#include <algorithm>
#include <cmath>

#include "circle.hpp"
#include "grammar.hpp"

namespace machines {
namespace {

constexpr double gravity = 9.81;  // [m/s^2]

void state(Machine& machine, const std::string& name, const std::string& rate, const std::string& unit,
           const std::string& initial = "0") {
  machine.states.push_back({name, rate, unit, initial});
}

// Electrical lag between voltage and torque, in physical parameters.
void drive_with_current(Random& random, Machine& machine, double time, double top_speed, double volts) {
  const double inertia = random.log_uniform(1e-5, 5), constant = 0.8 * volts / top_speed;
  const double resistance = constant * constant * time / inertia;  // time constant J R / kt^2
  machine.parameters = {guess(random, "J", "kg m^2", inertia, random.chance(0.5)),
                        guess(random, "kt", "N m/A", constant), guess(random, "R", "ohm", resistance),
                        guess(random, "L", "H", resistance * time * random.uniform(0.1, 0.4))};
  machine.signals.push_back({"torque", "kt*current", "N m"});
  state(machine, "w", "torque/J", "rad/s");
  machine.states[0].effort = "J", machine.states[0].effort_unit = "N m";
  machine.states[0].drive = "torque";
  state(machine, "current", "(voltage - R*current - kt*w)/L", "A");
}

}  // namespace

Draft draw_drive(Random& random, const Grammar&) {
  Draft draft;
  Machine& machine = draft.machine;
  machine.family = "drive";
  machine.title = "drive";
  const double time = random.log_uniform(0.05, 4), top = random.log_uniform(2, 600);
  const double volts = random.choice(Values{1, 6, 12, 24});
  machine.inputs = {{"voltage", volts == 1 ? "command_1" : "motor_V", volts == 1 ? "1" : "V", 1}};
  draft.middle = {0}, draft.swing = {volts};
  if (random.chance(0.3)) {
    drive_with_current(random, machine, time, top, volts);
    machine.title += " with inductance";
  } else {
    machine.parameters = {guess(random, "a", "1/s", 1 / time), guess(random, "b", "1/s^2", top / (time * volts))};
    machine.signals.push_back({"thrust", "b*voltage", "rad/s^2", true, 1});
    state(machine, "w", "thrust - a*w", "rad/s");
    machine.states[0].drive = "thrust";
    if (random.chance(0.5)) machine.states[0].effort = "1", machine.states[0].effort_unit = "rad/s^2";
  }
  machine.states[0].is_speed = true;
  machine.outputs.push_back({"w_rad_s", "w", "rad/s", 0});
  machine.states[0].initial = "column:w_rad_s";
  if (random.chance(0.35)) {
    state(machine, "angle", "w", "rad", "column:angle_rad");
    const int angle = static_cast<int>(machine.states.size()) - 1;
    machine.states[0].position = angle;
    if (random.chance(0.5)) machine.outputs.clear(), machine.states[0].initial = "0";
    machine.outputs.push_back({"angle_rad", "angle", "rad", angle});
  }
  machine.time_scale = 2 * time;
  machine.period = three_digits(std::clamp(time / random.uniform(6, 20), 0.002, 0.1));
  draft.duration = time * random.uniform(15, 40);
  return draft;
}

// Only ratios of its parameters matter, unless the mass is known.
Draft draw_lift(Random& random, const Grammar& grammar) {
  Draft draft;
  Machine& machine = draft.machine;
  machine.family = "lift";
  machine.title = "lift";
  const double time = random.log_uniform(0.4, 4), frequency = circle / time, mass = random.log_uniform(0.03, 3000);
  const double reach = random.uniform(0.05, 0.4) * gravity / (frequency * frequency), top = 2.5 * mass * gravity;
  machine.parameters = {guess(random, "m", "kg", mass, random.chance(0.25)), guess(random, "k_f", "N", top),
                        guess(random, "c", "N s/m", 2 * random.uniform(0.1, 0.5) * mass * frequency)};
  machine.constants = {{"g", gravity}, {"hover", 0.4, ""}};
  const bool own = grammar.draw_own(random);
  const double kp = mass * frequency * frequency / top, kd = 1.2 * mass * frequency / top;
  machine.constants.push_back({"kp", three_digits(kp)});
  machine.constants.push_back({"kd", three_digits(kd)});
  machine.inputs = {{"goal", "goal_m", "m"}};
  draft.middle = {0}, draft.swing = {reach};
  std::string duty = "hover + kp*(goal - h) - kd*v";
  if (own) {
    machine.constants.push_back({"ki", three_digits(0.1 * kp * frequency)});
    duty += " + ki*sum";
    machine.title += ", integral control";
  }
  machine.signals = {{"duty", random.chance(0.5) ? "min(max(" + duty + ", 0), 1)" : duty, "1", true, 2},
                     {"thrust", "k_f*duty", "N", true, 2}};
  state(machine, "h", "v", "m", "column:h_m");
  state(machine, "v", "(thrust - c*v)/m - g", "m/s");
  State& speed = machine.states[1];
  if (random.chance(0.8)) speed.effort = "m", speed.effort_unit = "N";
  speed.is_speed = true, speed.position = 0, speed.drive = "thrust";
  if (own) state(machine, "sum", "goal - h", "m s");
  machine.outputs = {{"h_m", "h", "m", 0}};
  if (random.chance(0.3)) machine.outputs.push_back({"v_m_s", "v", "m/s", 1}), speed.initial = "column:v_m_s";
  machine.time_scale = time;
  machine.period = three_digits(std::clamp(time / random.uniform(30, 80), 0.002, 0.1));
  draft.duration = time * random.uniform(8, 20);
  return draft;
}

Draft draw_rover(Random& random, const Grammar& grammar) {
  Draft draft;
  Machine& machine = draft.machine;
  machine.family = "rover";
  const double time = random.log_uniform(0.5, 5), radius = random.log_uniform(0.015, 0.4);
  const double base = radius * random.uniform(3, 8), turning = random.uniform(2, 10);  // [rad/s] of a wheel
  const bool slow = random.chance(0.4) || grammar.draw_own(random);
  machine.title = slow ? "rover with slow wheels" : "rover";
  machine.parameters = {guess(random, "radius", "m", radius, random.chance(0.3)), guess(random, "base", "m", base)};
  for (const std::string side : {"left", "right"}) {
    machine.inputs.push_back({side, side + "_rad_s", "rad/s"});
    draft.middle.push_back(random.uniform(0.2, 1) * turning), draft.swing.push_back(turning);
  }
  const std::string left = slow ? "wl" : "left", right = slow ? "wr" : "right";
  machine.signals = {{"forward", "radius/2*(" + left + " + " + right + ")", "m/s", !slow},
                     {"turn", "radius/base*(" + right + " - " + left + ")", "rad/s", !slow}};
  state(machine, "x", "forward*cos(yaw)", "m", "column:x_m");
  state(machine, "y", "forward*sin(yaw)", "m", "column:y_m");
  state(machine, "yaw", "turn", "rad", "column:yaw_rad");
  if (slow) {
    machine.parameters.push_back(guess(random, "tau", "s", time * random.uniform(0.03, 0.15)));
    state(machine, "wl", "(left - wl)/tau", "rad/s");
    state(machine, "wr", "(right - wr)/tau", "rad/s");
  }
  machine.outputs = {{"x_m", "x", "m", 0}, {"y_m", "y", "m", 1}, {"yaw_rad", "yaw", "rad", 2}};
  machine.time_scale = time;
  machine.period = three_digits(std::clamp(time / random.uniform(25, 60), 0.01, 0.1));
  draft.duration = time * random.uniform(6, 15);
  draft.initial_range = {10 * radius, -6 * radius, 1.5};
  draft.initial_range.resize(machine.states.size(), 0);
  return draft;
}

}  // namespace machines
