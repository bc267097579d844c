// A carriage on rails, pulled by a spring and an ordered force; its position is measured.
#include "excitation.hpp"
#include "one_dof.hpp"
#include "systems.hpp"

namespace plants {
namespace {

// Variants of the nominal model: the mass is a parameter or weighed for each recording, with a damper or without.
struct Variant {
  bool weighed = false, damped = true;
};

struct CarriageMachine {
  double stiffness, damping, inertia, motor_inertia = 0;
  double top;  // largest ordered force [N]

  CarriageMachine(const Values& p, const Recording& recording)
      : stiffness(p[0]), damping(p[1]), inertia(p[2]), top(recording.meta[1].second) {
    if (recording.meta[0].second > 0) inertia = recording.meta[0].second;
  }

  double signal(double force, double) const { return force; }
  double work(double force, double) const { return std::abs(force) / top; }
  double drive(double force, double) const { return force; }
  double load(double position, double speed) const { return -stiffness * position - damping * speed; }
};

std::string carriage_toml(const System& system, const Variant& variant, bool with_noise) {
  std::string toml =
      "schema = \"surefoot.model/1\"\nname   = \"carriage with spring\"\nkind   = \"ode\"\ntime   = \"t_s\"\n";
  toml += "\n[inputs]\nforce = \"force_N\"\n\n[let]\n";
  toml += "pull = \"-stiffness*x" + std::string(variant.damped ? " - damping*v" : "") + "\"\n";
  toml += "\n[states]\nx = { rate = \"v\", initial = \"column:x_m\", unit = \"m\" }\n";
  toml +=
      "v = { rate = \"(force + pull)/mass\", initial = \"0\", unit = \"m/s\", effort = \"mass\", effort_unit = \"N\" "
      "}\n";
  toml += "\n[outputs]\nx_m = { value = \"x\", unit = \"m\"" + noise_entry(with_noise, system.noise[0]) + " }\n";
  if (variant.weighed) toml += "\n[constants]\nmass = \"meta:mass_kg\"\n";
  System shown = system;
  if (variant.weighed) shown.parameters.erase(shown.parameters.begin() + 2);
  if (!variant.damped) shown.parameters.erase(shown.parameters.begin() + 1);
  return toml + parameters_toml(shown);
}

void record_carriage(Random& random, System& system, const Variant& variant) {
  const double stiffness = system.parameters[0].actual, mass = system.parameters[2].actual;
  const double natural_period = 2 * std::numbers::pi * std::sqrt(mass / stiffness);  // [s]
  const double amplitude = random.uniform(0.08, 0.25);                               // [m]
  const std::vector<Shape> shapes{Shape::multisine, Shape::steps, Shape::chirp, Shape::ramps};
  const bool jitter = random.chance(0.7);
  for (std::size_t i = 0; i < 8; ++i) {
    Recording recording;
    recording.name = "rec_0" + std::to_string(i + 1) + ".csv";
    const double weighed = variant.weighed ? rounded(mass * random.choice(Values{0.7, 1.0, 1.4}), 0.001) : 0;
    const double top = rounded(amplitude * stiffness * random.uniform(0.4, 1), 0.01);
    recording.meta = {{variant.weighed ? "mass_kg" : "_mass", weighed}, {"_top", top}};
    recording.time = jittered_times(random, random.uniform(6, 9), 0.01, jitter);
    recording.inputs = {
        excite(random, recording.time, shapes[i % 4], 0, top, natural_period * random.uniform(0.8, 2), 1e-3)};
    recording.initial = {random.chance(0.3) ? random.uniform(-0.5, 0.5) * amplitude : 0, 0};
    system.recordings.push_back(recording);
  }
}

Fault named_fault(Random& random, const System& system, const Typical& typical, double period) {
  static const std::vector<std::string> names = words(
      "viscous_friction coulomb_friction coulomb_friction stribeck_friction load_dependent_friction "
      "quadratic_drag constant_force cubic_stiffness cubic_stiffness hysteresis backlash joint_elasticity "
      "cogging end_stop force:input_gain force:input_asymmetry force:dead_zone force:saturation "
      "force:rate_limit force:input_delay force:first_order_lag force:supply_sag sensor_bias sensor_scale "
      "sensor_delay sensor_drift quantization parameter_drift");
  const std::string name = random.choice(names);
  if (name.rfind("sensor", 0) == 0 || name == "quantization") {
    return draw_sensor(random, name, "x_m", "m", 0, typical.position, system.noise[0], 7);
  }
  if (name.rfind("force:", 0) == 0) {
    const double top = 1.6 * typical.order;
    Fault fault = draw_signal(random, name.substr(6), "force", "N", Place::input, typical.order, top, 0.15 * period);
    if (fault.formula == Formula::supply_sag) {
      fault.a /= top;
      fault.numbers = {{"sag", fault.a, "1/N"}};
    }
    return fault;
  }
  if (name == "parameter_drift") {
    Fault fault;
    fault.name = name;
    fault.place = Place::parameter;
    fault.same_formula = random.chance(0.5);
    fault.formula = fault.same_formula ? Formula::parameter_drift : Formula::parameter_warm;
    fault.a = random.sign() * (fault.same_formula ? random.uniform(0.008, 0.04) : random.uniform(0.08, 0.25));
    fault.b = 3;  // [s]
    fault.attached_to = "stiffness";
    fault.numbers = {{"rate", fault.a, "1/s"}};
    return fault;
  }
  Fault fault = draw_force(random, typical, name);
  if (name == "backlash") {  // the spring's mount has play; there is no gear
    fault.formula = Formula::play_seen;
    fault.same_formula = true;
  }
  return fault;
}

}  // namespace

Simulate carriage_simulation() {
  return [](const Values& p, const std::vector<Fault>& faults, const Recording& recording, const How& how) {
    return OneDofRun<CarriageMachine>(p, faults, recording, how).run(false);
  };
}

System carriage(Random& random) {
  System system;
  system.family = "carriage";
  system.model_name = "carriage with spring";
  const Variant variant{random.chance(0.5), random.chance(0.75)};
  const double mass = random.uniform(0.5, 2), natural = 2 * std::numbers::pi * random.uniform(0.5, 1.3);
  Parameter damping{"damping", "N s/m", 0, 0, 0, 0, true};
  const double actual_damping = 2 * mass * natural * random.uniform(0.03, 0.2);
  if (variant.damped) damping = guessed(random, "damping", "N s/m", actual_damping);
  system.parameters = {guessed(random, "stiffness", "N/m", mass * natural * natural), damping,
                       guessed(random, "mass", "kg", mass, variant.weighed)};
  system.inputs = {"force_N"};
  system.outputs = {"x_m"};
  system.noise = {random.log_uniform(2e-4, 1.2e-3)};
  system.simulate = carriage_simulation();
  record_carriage(random, system, variant);
  system.model_toml = [system, variant](bool with_noise) { return carriage_toml(system, variant, with_noise); };

  Typical typical;
  typical.reach = 0;
  measure_motion(system, typical);
  typical.effort *= mass;
  typical.speed_state = "v", typical.position_state = "x";
  typical.effort_unit = "N", typical.position_unit = "m", typical.speed_unit = "m/s";
  const System nominal = system;
  const double period = 2 * std::numbers::pi / natural;
  system.draw_named = [nominal, typical, period](Random& draws) {
    return named_fault(draws, nominal, typical, period);
  };
  system.draw_outside = [typical](Random& draws) { return draw_outside_force(draws, typical); };
  return system;
}

}  // namespace plants
