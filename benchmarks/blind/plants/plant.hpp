// Parts of the plants: recordings, faults (the hidden physics) and systems (a nominal model that can be
// simulated with any parameters and faults).
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "random.hpp"

namespace plants {

using Column = std::vector<double>;  // one value per row

/// One experiment: what was ordered, what really came out, what was read.
struct Recording {
  std::string name;                                  // file name
  std::vector<std::pair<std::string, double>> meta;  // constants, name with unit; not written when it starts with _
  Column time;                                       // [s], uneven; empty for walks, whose rows are steps
  std::vector<Column> inputs;                        // held from row to row
  std::vector<double> initial;                       // true initial state
  std::vector<Column> ideal;                         // per output: noise-free
  std::vector<Column> readings;                      // per output: as written, NaN = not measured
  std::vector<std::vector<bool>> outliers;           // per output: reading is a measurement error
};

/// A number of a fault, as the truth file shows it.
struct Number {
  std::string name;
  double value = 0;
  std::string unit;
};

/// Formulas of faults. Those marked * are outside the library of named effects.
enum class Formula {
  // forces on a speed
  viscous,
  dry,
  dry_tanh,
  stribeck,
  load_dry,
  drag,
  constant,
  cubic,
  hysteresis,
  hysteresis_square,
  play_seen,
  two_mass_play,
  elasticity,
  cogging,
  cogging_triangle,
  gravity_offset,
  stop_hard,
  stop_spring,
  detent /*: * torque near one angle */,
  sticky_patch /*: * resistance near one position */,
  warm_spring /*: * spring that softens with its own work */,
  changing_mass /*: * mass grows away from the middle */,
  gusts /*: * periodic disturbance in time */,
  weak_zone /*: * drive fades in a stretch of positions */,
  // rates of any state
  leak,
  constant_rate,
  overflow,
  pump_ripple /*: * */,
  vortex /*: * outlet chokes below a level */,
  sloshing /*: * exchange between levels that swings in time */,
  // inputs and signals
  gain,
  asymmetry,
  dead_soft,
  dead_step,
  saturation,
  saturation_soft,
  rate_limit,
  delay,
  lag,
  lag_second,
  supply_sag,
  // sensors
  bias,
  scale,
  sensor_delay,
  drift,
  drift_warm,
  quantization,
  quantization_floor,
  // parameters
  parameter_drift,
  parameter_warm,
  // walks
  slip,
  slip_hard,
  body_drift,
  slope,
  slope_distance,
  coupling,
  stumble /*: * kick at large combined orders */,
  patch /*: * slippery patch of floor */,
  odd_steps /*: * every other step differs */,
  turn_kick /*: * heading-dependent twist, twice per turn */
};

enum class Place { force, state, input, signal, sensor, parameter, planar };

/// One piece of hidden physics.
struct Fault {
  std::string name;  // name of the effect, or "outside: ..."
  std::string attached_to;
  std::vector<std::string> also = {};  // other places that mean the same
  Place place = Place::force;
  Formula formula = Formula::viscous;
  int target = 0;              // index of state, input, output or parameter
  double a = 0, b = 0, c = 0;  // what the formula uses
  bool same_formula = true;
  std::vector<Number> numbers = {};
  std::vector<std::pair<std::string, std::string>> equivalents = {};  // names and places of which no test could tell it
};

struct Parameter {
  std::string name, unit;
  double actual = 0, nominal = 0;
  double low = 0, high = 0;  // bounds for calibration
  bool fixed = false;
};

/// States and noise-free outputs at the rows.
struct Series {
  std::vector<Column> states, outputs;
};

using Values = std::vector<double>;

/// How a recording is simulated.
struct How {
  int substeps = 2;            // integration steps between rows
  bool from_readings = false;  // initial state as a user of the nominal model has it: from the first readings
  bool stepwise = false;       // walks: every step starts from the measured pose
  Random* noise = nullptr;     // walks: process noise
  bool fit_free = false;       // machines: initial values that the model file leaves free are fitted to the readings
  bool unrounded = false;      // machines: sensors that round read what they round, at its mean: for derivatives
};

using Simulate = std::function<Series(const Values&, const std::vector<Fault>&, const Recording&, const How&)>;

/// A family's machine, drawn at random: nominal model, true parameters, experiments.
struct System {
  std::string family, model_name;
  std::vector<Parameter> parameters;
  std::vector<std::string> inputs, outputs;  // column names
  std::vector<double> noise;                 // [output unit], standard deviation of the measurement noise
  std::vector<double> process_noise;         // walks: per step [m, m, rad]
  bool final_only = false;                   // outputs are measured in the last row only
  bool stepwise = false;                     // parameters are fitted step by step
  std::vector<Recording> recordings;
  Simulate simulate;
  std::function<std::string(bool with_noise)> model_toml;
  std::function<Fault(Random&)> draw_named, draw_outside;
};

System servo(Random& random);
System carriage(Random& random);
System tanks(Random& random);
System walk(Random& random, bool final_only);

/// Simulators of the families; parameters as in their model files. servo: speed measured too; tanks: both levels
/// measured.
Simulate servo_simulation(bool speed);
Simulate carriage_simulation();  // parameters: stiffness, damping, mass
Simulate tanks_simulation(bool both);
Simulate walk_simulation(const Values& process_noise);

inline Values actual_values(const System& system) {
  Values values;
  for (const Parameter& parameter : system.parameters) values.push_back(parameter.actual);
  return values;
}

}  // namespace plants
