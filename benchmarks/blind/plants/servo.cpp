// A position servo with a DC motor swings a load: the nominal model of the README, several loads and gains.
#include "excitation.hpp"
#include "one_dof.hpp"
#include "systems.hpp"

namespace plants {
namespace {

constexpr double gravity = 9.81;  // [m/s^2]

// Order of the parameters and of a recording's constants.
enum { kt, resistance, armature };
enum { mass, length, kp, vin };

struct ServoMachine {
  double gain, torque_per_duty, back_emf, weight, inertia, motor_inertia;

  ServoMachine(const Values& p, const Recording& recording)
      : gain(recording.meta[kp].second),
        torque_per_duty(p[kt] / p[resistance] * recording.meta[vin].second),
        back_emf(p[kt] * p[kt] / p[resistance]),
        weight(recording.meta[mass].second * gravity * recording.meta[length].second),
        inertia(p[armature] +
                recording.meta[mass].second * recording.meta[length].second * recording.meta[length].second),
        motor_inertia(p[armature]) {}

  double signal(double goal, double position) const { return std::clamp(gain * (goal - position), -1.0, 1.0); }
  double work(double duty, double) const { return std::abs(duty); }
  double drive(double duty, double speed) const { return torque_per_duty * duty - back_emf * speed; }
  double load(double position, double) const { return -weight * std::sin(position); }
};

std::string servo_toml(const System& system, bool with_noise) {
  std::string toml = R"toml(schema = "surefoot.model/1"
name   = "servo pendulum"
kind   = "ode"
time   = "t_s"

[inputs]
goal = "goal_rad"

[let]
duty    = "min(max(kp*(goal - theta), -1), 1)"
tau     = "kt/R*(vin*duty - kt*omega)"
inertia = "armature + mass*length*length"

[states]
theta = { rate = "omega", initial = "column:theta_rad", unit = "rad" }
omega = { rate = "(tau - mass*g*length*sin(theta))/inertia", initial = "0", unit = "rad/s", effort = "inertia", effort_unit = "N m" }

[outputs]
)toml";
  toml += "theta_rad = { value = \"theta\", unit = \"rad\"" + noise_entry(with_noise, system.noise[0]) + " }\n";
  if (system.outputs.size() > 1) {
    toml += "omega_rad_s = { value = \"omega\", unit = \"rad/s\"" + noise_entry(with_noise, system.noise[1]) + " }\n";
  }
  toml +=
      "\n[constants]\ng = 9.81\nmass = \"meta:mass_kg\"\nlength = \"meta:length_m\"\nkp = \"meta:kp\"\nvin = "
      "\"meta:vin_V\"\n";
  return toml + parameters_toml(system);
}

void record_servo(Random& random, System& system) {
  const double supply = random.uniform(7, 13), scale = random.uniform(0.7, 1.4);
  const std::vector<Shape> shapes{Shape::steps, Shape::multisine, Shape::ramps, Shape::chirp};
  const bool jitter = random.chance(0.7);
  for (std::size_t i = 0; i < 8; ++i) {
    Recording recording;
    recording.name = "rec_0" + std::to_string(i + 1) + ".csv";
    recording.meta = {{"mass_kg", rounded(scale * random.choice(Values{0.2, 0.35, 0.5}), 0.001)},
                      {"length_m", random.choice(Values{0.1, 0.13, 0.16})},
                      {"kp", random.choice(Values{2, 4, 8})},
                      {"vin_V", rounded(supply, 0.1)}};
    recording.time = jittered_times(random, random.uniform(4, 6), 0.005, jitter);
    recording.inputs = {
        excite(random, recording.time, shapes[i % 4], 0, random.uniform(0.4, 1.4), random.uniform(0.6, 1.5), 1e-4)};
    recording.initial = {0, 0};
    system.recordings.push_back(recording);
  }
}

Fault named_fault(Random& random, const System& system, const Typical& typical) {
  static const std::vector<std::string> names = words(
      "viscous_friction coulomb_friction coulomb_friction stribeck_friction stribeck_friction "
      "load_dependent_friction quadratic_drag constant_force cubic_stiffness hysteresis backlash backlash "
      "joint_elasticity cogging gravity_offset end_stop goal:input_gain duty:input_asymmetry duty:dead_zone "
      "duty:saturation goal:rate_limit goal:input_delay goal:first_order_lag duty:first_order_lag "
      "duty:supply_sag sensor_bias sensor_scale sensor_delay sensor_drift quantization parameter_drift");
  const std::string name = random.choice(names);
  if (name.rfind("sensor", 0) == 0 || name == "quantization") {
    return draw_sensor(random, name, "theta_rad", "rad", 0, typical.position, system.noise[0], 5);
  }
  if (name.rfind("goal:", 0) == 0) {
    return draw_signal(random, name.substr(5), "goal", "rad", Place::input, typical.order, 1.2, 0.15);
  }
  if (name.rfind("duty:", 0) == 0) return draw_signal(random, name.substr(5), "duty", "1", Place::signal, 0.4, 1, 0.1);
  if (name == "parameter_drift") {
    Fault fault;
    fault.name = name;
    fault.place = Place::parameter;
    fault.target = random.chance(0.5) ? kt : resistance;
    fault.same_formula = random.chance(0.5);
    fault.formula = fault.same_formula ? Formula::parameter_drift : Formula::parameter_warm;
    fault.a =
        fault.same_formula ? random.sign() * random.uniform(0.02, 0.08) : random.sign() * random.uniform(0.1, 0.4);
    fault.b = 2.5;  // [s]
    fault.attached_to = system.parameters[static_cast<std::size_t>(fault.target)].name;
    fault.also = {"kt", "R"};
    fault.numbers = {{"rate", fault.a, "1/s"}};
    return fault;
  }
  Fault fault = draw_force(random, typical, name);
  if (name == "load_dependent_friction")
    fault.same_formula = false;  // the share of a loop's drive is a matter of definition
  if (name == "backlash") fault.also.insert(fault.also.end(), {"theta_rad", "tau", "duty"});
  return fault;
}

}  // namespace

Simulate servo_simulation(bool speed) {
  return [speed](const Values& p, const std::vector<Fault>& faults, const Recording& recording, const How& how) {
    return OneDofRun<ServoMachine>(p, faults, recording, how).run(speed);
  };
}

System servo(Random& random) {
  System system;
  system.family = "servo";
  system.model_name = "servo pendulum";
  const bool known_motor = random.chance(0.4);
  system.parameters = {guessed(random, "kt", "N m/A", random.uniform(0.9, 2.2), known_motor),
                       guessed(random, "R", "ohm", random.uniform(2.5, 6)),
                       guessed(random, "armature", "kg m^2", random.uniform(0.004, 0.015))};
  system.inputs = {"goal_rad"};
  system.outputs = {"theta_rad"};
  system.noise = {random.log_uniform(4e-4, 2.5e-3)};
  if (random.chance(0.25)) {
    system.outputs.push_back("omega_rad_s");
    system.noise.push_back(random.uniform(0.02, 0.08));
  }
  const bool speed = system.outputs.size() > 1;
  system.simulate = servo_simulation(speed);
  record_servo(random, system);
  system.model_toml = [system](bool with_noise) { return servo_toml(system, with_noise); };

  Typical typical;
  typical.reach = 0.2;
  measure_motion(system, typical);
  double inertia = 0;
  for (const Recording& r : system.recordings) inertia += ServoMachine(actual_values(system), r).inertia / 8;
  typical.effort *= inertia;
  typical.speed_state = "omega", typical.position_state = "theta";
  typical.effort_unit = "N m", typical.position_unit = "rad", typical.speed_unit = "rad/s";
  const System nominal = system;
  system.draw_named = [nominal, typical](Random& draws) { return named_fault(draws, nominal, typical); };
  system.draw_outside = [typical](Random& draws) { return draw_outside_force(draws, typical); };
  return system;
}

}  // namespace plants
