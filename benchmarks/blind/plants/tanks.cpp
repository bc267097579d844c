// Two tanks above each other: a pump fills the upper one, which empties into the lower one, which empties into the
// reservoir. One or both levels are measured.
#include <array>

#include "excitation.hpp"
#include "one_dof.hpp"
#include "systems.hpp"

namespace plants {
namespace {

// Order of the parameters.
enum { pump_gain, upper_outlet, lower_outlet };

using Levels = std::array<double, 2>;  // [cm] upper, lower

double outflow(const std::vector<Fault>& faults, int tank, double coefficient, double level) {
  double flow = coefficient * std::sqrt(std::max(level, 0.0));
  for (const Fault& fault : faults)
    if (fault.formula == Formula::vortex && fault.target == tank) {
      flow *= 1 - fault.a / (1 + std::exp((level - fault.b) / fault.c));
    }
  return flow;
}

Levels rates(const Values& p, const std::vector<Fault>& faults, double time, double volts, const Levels& level) {
  double pumped = p[pump_gain] * volts;
  Levels rate{0, 0};
  for (const Fault& fault : faults) {
    const auto tank = static_cast<std::size_t>(fault.target);
    const double phase = 2 * std::numbers::pi * time / std::max(fault.b, 1e-9) + fault.c;
    if (fault.formula == Formula::pump_ripple) pumped *= 1 + fault.a * std::sin(phase);
    if (fault.formula == Formula::leak) {
      rate[tank] -= fault.a * (fault.same_formula ? level[tank] : fault.b * std::sqrt(std::max(level[tank], 0.0) + 1));
    }
    if (fault.formula == Formula::constant_rate) rate[tank] += fault.a;
    if (fault.formula == Formula::sloshing) rate[tank] += fault.a * std::sin(phase) * level[tank];
  }
  const double between = outflow(faults, 0, p[upper_outlet], level[0]);
  rate[0] += pumped - between;
  rate[1] += between - outflow(faults, 1, p[lower_outlet], level[1]);
  return rate;
}

void spill(const std::vector<Fault>& faults, Levels& level) {
  for (const Fault& fault : faults) {
    const auto tank = static_cast<std::size_t>(fault.target);
    if (fault.formula != Formula::overflow || level[tank] <= fault.a) continue;
    const double excess = level[tank] - fault.a;
    level[tank] -= excess;
    if (tank == 0) level[1] += fault.b * excess;
  }
  for (double& value : level) value = std::max(value, 0.0);
}

Series simulate(const Values& parameters, const std::vector<Fault>& faults, const Recording& recording, const How& how,
                bool both) {
  const FineGrid grid = fine_grid(recording, 0, faults, how.substeps);
  Levels level{recording.initial[0], recording.initial[1]};
  if (how.from_readings) {
    level[1] = recording.readings[both ? 1 : 0][0];
    if (both) level[0] = recording.readings[0][0];
  }
  Series series{{{level[0]}, {level[1]}}, {}};
  const auto substeps = static_cast<std::size_t>(how.substeps);
  for (std::size_t i = 0; i < grid.times.size(); ++i) {
    const std::size_t row = i / substeps;
    const double time = grid.times[i], step = (recording.time[row + 1] - recording.time[row]) / how.substeps;
    Values p = parameters;
    for (const Fault& fault : faults)
      if (fault.place == Place::parameter)
        p[static_cast<std::size_t>(fault.target)] *= factor_of_parameter(fault, time);
    const auto moved = [&](const Levels& slope, double share) {
      return Levels{level[0] + share * step * slope[0], level[1] + share * step * slope[1]};
    };
    const Levels k1 = rates(p, faults, time, grid.order[i], level);
    const Levels k2 = rates(p, faults, time + step / 2, grid.order[i], moved(k1, 0.5));
    const Levels k3 = rates(p, faults, time + step / 2, grid.order[i], moved(k2, 0.5));
    const Levels k4 = rates(p, faults, time + step, grid.order[i], moved(k3, 1));
    for (std::size_t k = 0; k < 2; ++k) level[k] += step / 6 * (k1[k] + 2 * k2[k] + 2 * k3[k] + k4[k]);
    spill(faults, level);
    if ((i + 1) % substeps != 0) continue;
    series.states[0].push_back(level[0]);
    series.states[1].push_back(level[1]);
  }
  if (both) series.outputs.push_back(series.states[0]);
  series.outputs.push_back(series.states[1]);
  for (const Fault& fault : faults)
    if (fault.place == Place::sensor) {
      change_readings(fault, recording.time, series.outputs[static_cast<std::size_t>(fault.target)]);
    }
  return series;
}

std::string tanks_toml(const System& system, bool with_noise) {
  const bool both = system.outputs.size() > 1;
  std::string toml = R"toml(schema = "surefoot.model/1"
name   = "two tanks"
kind   = "ode"
time   = "t_s"

[inputs]
pump = "pump_V"

[let]
between = "upper_outlet*sqrt(max(upper, 0))"

[states]
)toml";
  toml += "upper = { rate = \"pump_gain*pump - between\", initial = ";
  toml += std::string(both ? "\"column:upper_cm\"" : "\"free\"") + ", unit = \"cm\" }\n";
  toml +=
      "lower = { rate = \"between - lower_outlet*sqrt(max(lower, 0))\", initial = \"column:lower_cm\", unit = \"cm\" "
      "}\n";
  toml += "\n[outputs]\n";
  if (both) toml += "upper_cm = { value = \"upper\", unit = \"cm\"" + noise_entry(with_noise, system.noise[0]) + " }\n";
  toml += "lower_cm = { value = \"lower\", unit = \"cm\"" + noise_entry(with_noise, system.noise.back()) + " }\n";
  return toml + parameters_toml(system);
}

// Levels at rest for a constant order [V].
Levels resting(const System& system, double volts) {
  const double inflow = system.parameters[pump_gain].actual * volts;
  const double upper = inflow / system.parameters[upper_outlet].actual,
               lower = inflow / system.parameters[lower_outlet].actual;
  return {upper * upper, lower * lower};
}

void record_tanks(Random& random, System& system) {
  const bool jitter = random.chance(0.7);
  const std::vector<Shape> shapes{Shape::steps, Shape::multisine, Shape::steps};
  for (std::size_t i = 0; i < 7; ++i) {
    Recording recording;
    recording.name = "rec_0" + std::to_string(i + 1) + ".csv";
    recording.time = jittered_times(random, random.uniform(250, 400), 1.0, jitter);
    const double middle = random.uniform(3.5, 5), amplitude = random.uniform(1.5, 3);
    recording.inputs = {excite(random, recording.time, shapes[i % 3], middle, amplitude, random.uniform(40, 80), 1e-3)};
    for (double& volts : recording.inputs[0]) volts = std::clamp(volts, 0.0, 10.0);
    const Levels start = resting(system, random.uniform(2, 5));
    recording.initial = {start[0], start[1]};
    system.recordings.push_back(recording);
  }
}

struct Sizes {
  double spread[2] = {1, 1}, top[2] = {0, 0}, inflow = 1;  // [cm], [cm], [cm/s]
};

Fault state_fault(Random& random, const std::string& name, const Sizes& sizes) {
  static const std::vector<std::string> states{"upper", "lower"};
  Fault fault;
  fault.name = name;
  fault.place = Place::state;
  fault.target = random.chance(0.5) ? 0 : 1;
  const auto tank = static_cast<std::size_t>(fault.target);
  fault.attached_to = states[tank];
  if (name == "leak") {
    fault.formula = Formula::leak;
    fault.same_formula = true;
    fault.a = random.log_uniform(0.02, 0.35) * sizes.inflow / sizes.top[tank];
    fault.b = std::sqrt(sizes.top[tank]);
    fault.numbers = {{"rate", fault.a, "1/s"}};
  } else if (name == "overflow") {
    fault.formula = Formula::overflow;
    fault.a = random.uniform(0.5, 0.85) * sizes.top[tank];
    fault.b = tank == 0 && random.chance(0.6) ? random.uniform(0.4, 1) : 0;
    fault.numbers = {{"level", fault.a, "cm"}};
  } else {
    fault.formula = Formula::constant_rate;
    fault.a = random.sign() * random.log_uniform(0.015, 0.3) * sizes.inflow;
    fault.numbers = {{"rate", fault.a, "cm/s"}};
  }
  return fault;
}

Fault named_fault(Random& random, const System& system, const Sizes& sizes) {
  static const std::vector<std::string> names = words(
      "leak leak constant_rate overflow overflow pump:dead_zone pump:saturation pump:rate_limit "
      "pump:input_delay pump:first_order_lag pump:supply_sag sensor_bias sensor_scale sensor_delay "
      "sensor_drift quantization parameter_drift");
  const std::string name = random.choice(names);
  if (name.rfind("sensor", 0) == 0 || name == "quantization") {
    const std::size_t output = random.index(system.outputs.size());
    const std::size_t tank = system.outputs.size() > 1 ? output : 1;
    return draw_sensor(random, name, system.outputs[output], "cm", static_cast<int>(output), sizes.spread[tank],
                       system.noise[output], 300);
  }
  if (name.rfind("pump:", 0) == 0) {
    Fault fault = draw_signal(random, name.substr(5), "pump", "V", Place::input, 4, 7.5, 15);
    if (fault.formula == Formula::dead_step) fault.formula = Formula::dead_soft, fault.same_formula = true;
    if (fault.formula == Formula::supply_sag) {
      fault.a /= 10;
      fault.numbers = {{"sag", fault.a, "1/V"}};
    }
    return fault;
  }
  if (name == "parameter_drift") {
    Fault fault;
    fault.name = name;
    fault.place = Place::parameter;
    fault.target = static_cast<int>(random.index(3));
    fault.same_formula = random.chance(0.5);
    fault.formula = fault.same_formula ? Formula::parameter_drift : Formula::parameter_warm;
    fault.a = random.sign() * (fault.same_formula ? random.uniform(3e-4, 1.2e-3) : random.uniform(0.1, 0.35));
    fault.b = 120;  // [s]
    fault.attached_to = system.parameters[static_cast<std::size_t>(fault.target)].name;
    fault.numbers = {{"rate", fault.a, "1/s"}};
    return fault;
  }
  return state_fault(random, name, sizes);
}

Fault outside_fault(Random& random, const Sizes& sizes) {
  Fault fault;
  fault.place = Place::state;
  fault.same_formula = false;
  fault.target = random.chance(0.5) ? 0 : 1;
  fault.attached_to = fault.target == 0 ? "upper" : "lower";
  const auto tank = static_cast<std::size_t>(fault.target);
  fault.c = random.uniform(0, 2 * std::numbers::pi);
  switch (random.index(3)) {
    case 0:
      fault.name = "outside: pump with a periodic disturbance";
      fault.attached_to = "pump";
      fault.formula = Formula::pump_ripple;
      fault.a = random.log_uniform(0.04, 0.4);
      fault.b = random.uniform(20, 70);  // [s]
      break;
    case 1:
      fault.name = "outside: outlet that chokes below a level";
      fault.formula = Formula::vortex;
      fault.a = random.log_uniform(0.07, 0.6);
      fault.b = random.uniform(0.25, 0.5) * sizes.top[tank];
      fault.c = 0.02 * sizes.top[tank];
      break;
    default:
      fault.name = "outside: exchange that swings with time and level";
      fault.formula = Formula::sloshing;
      fault.a = random.log_uniform(0.2, 0.8) * sizes.inflow / sizes.top[tank];
      fault.b = random.uniform(25, 80);  // [s]
  }
  return fault;
}

Sizes measure(const System& system, bool both) {
  Sizes sizes;
  Column levels[2];
  for (const Recording& recording : system.recordings) {
    const Series series = simulate(actual_values(system), {}, recording, {}, both);
    for (std::size_t k = 0; k < 2; ++k)
      levels[k].insert(levels[k].end(), series.states[k].begin(), series.states[k].end());
  }
  for (std::size_t k = 0; k < 2; ++k) {
    sizes.spread[k] = spread(levels[k]);
    sizes.top[k] = *std::max_element(levels[k].begin(), levels[k].end());
  }
  sizes.inflow = 4 * system.parameters[pump_gain].actual;
  return sizes;
}

}  // namespace

Simulate tanks_simulation(bool both) {
  return [both](const Values& p, const std::vector<Fault>& faults, const Recording& recording, const How& how) {
    return simulate(p, faults, recording, how, both);
  };
}

System tanks(Random& random) {
  System system;
  system.family = "tanks";
  system.model_name = "two tanks";
  const double outlet = random.uniform(0.4, 0.8);
  system.parameters = {guessed(random, "pump_gain", "cm/(s V)", random.uniform(0.8, 1.1) * outlet),
                       guessed(random, "upper_outlet", "cm^0.5/s", outlet),
                       guessed(random, "lower_outlet", "cm^0.5/s", outlet * random.uniform(0.85, 1.2))};
  system.inputs = {"pump_V"};
  const bool both = random.chance(0.6);
  if (both) system.outputs.push_back("upper_cm");
  system.outputs.push_back("lower_cm");
  system.noise.assign(system.outputs.size(), random.log_uniform(0.03, 0.15));
  system.simulate = tanks_simulation(both);
  record_tanks(random, system);
  system.model_toml = [system](bool with_noise) { return tanks_toml(system, with_noise); };
  const Sizes sizes = measure(system, both);
  const System nominal = system;
  system.draw_named = [nominal, sizes](Random& draws) { return named_fault(draws, nominal, sizes); };
  system.draw_outside = [sizes](Random& draws) { return outside_fault(draws, sizes); };
  return system;
}

}  // namespace plants
