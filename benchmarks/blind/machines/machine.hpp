// A machine as its model file describes it, and the physics hidden in it. Both are values: the grammar draws them, the
// simulation runs them, the writer prints the first.
#pragma once

#include <string>
#include <vector>

#include "../plants/plant.hpp"

namespace machines {

using plants::Column;
using plants::Random;
using plants::Recording;
using plants::Values;

struct Input {
  std::string name, column, unit;
  int group = 0;            // inputs and signals of one group > 0 are constant multiples of each other
  bool one_signed = false;  // pumps, heaters
};

/// A quantity of [let]. Effects may act on it where it is `driven`.
struct Signal {
  std::string name, formula, unit;
  bool driven = false;  // depends on inputs
  int group = 0;
};

struct State {
  std::string name, rate, unit;
  std::string initial = "0";  // as the model file says it
  std::string effort = {}, effort_unit = {};
  int position = -1;       // state that this one is the speed of
  bool is_speed = false;   // forces act on it
  std::string drive = {};  // signal: force of the motor on it
  std::string load = {};   // signal: weight or spring force on it
  bool is_amount = false;  // there is more or less of it: levels, temperatures
};

struct Output {
  std::string column, formula, unit;
  int state = 0;  // that it reads
};

struct Constant {
  std::string name;
  double value = 0;
  std::string meta = {};  // key in the recordings' first lines, in place of a value
};

/// Two states that a link joins, and the signal of its deflection.
struct Link {
  std::string signal;
  int first_speed = 0, second_speed = 0;
};

struct Machine {
  std::string family, title;
  std::vector<Input> inputs;
  std::vector<Signal> signals;
  std::vector<State> states;
  std::vector<Output> outputs;
  std::vector<Constant> constants;
  std::vector<plants::Parameter> parameters;
  std::vector<Link> links;
  double period = 0.01;     // between rows [s]
  double time_scale = 0.1;  // of its motion [s]
  bool at_rest = true;      // recordings begin at rest
  bool linear_inputs = false;  // straight from row to row; else held
};

enum class Where { speed, state, input, signal, sensor, parameter, link };

/// Formulas of hidden physics; many differ from those of the library.
enum class Law {
  // on speeds
  viscous,
  bristles,
  soft_bristles,
  smooth_dry,
  arctan_dry,
  rational_dry,
  stribeck_gauss,
  stribeck_exponential,
  stribeck_lorentz,
  load_bristles,
  square_drag,
  power_drag,
  constant,
  cubic,
  sinh_spring,
  tangent_spring,
  dahl,
  square_hysteresis,
  seen_backlash,
  load_behind_gap,
  resonator,
  sine_cogging,
  triangle_cogging,
  two_wave_cogging,
  weight_offset,
  hard_stop,
  elastic_stop,
  // on other states
  leak,
  hole,
  power_leak,
  raised_hole,
  rate,
  overflow,
  weir,
  // on inputs and signals
  gain,
  asymmetry,
  dead_zone,
  dead_step,
  clip,
  smooth_clip,
  tanh_clip,
  rate_limit,
  delay,
  lag,
  second_lag,
  third_lag,
  fourth_lag,
  sag,
  slow_sag,
  // in sensors
  bias,
  scale,
  sensor_delay,
  drift,
  warm_drift,
  round_off,
  floor_off,
  sensor_backlash,
  // of parameters
  linear_drift,
  warm_up,
  late_drift,
  midway_drift,
  passing_drift,
  // outside the library, on speeds
  detent,
  sticky_patch,
  growing_inertia,
  gusts,
  asymmetric_damping,
  two_resonators,
  weak_zone,
  heat_fade,
  // outside the library, on other states
  ripple,
  choke,
  exchange,
  radiation,
  // outside the library, on inputs and signals
  uneven_gain,
  ageing
};

/// One piece of hidden physics at its place.
struct Hidden {
  std::string name;                         // of the effect as the library calls it, or "outside: ..."
  std::string attached_to;                  // name of the place
  std::vector<std::string> also = {};       // other names of the place
  std::vector<std::string> multiples = {};  // places where it is the same with another strength
  Where where = Where::speed;
  Law law = Law::viscous;
  int target = 0;                     // state, input, signal, output or parameter
  int other = -1;                     // another state that is touched
  double a = 0, b = 0, c = 0, d = 0;  // what the law uses; a is its strength
  bool same_formula = true;
  std::vector<plants::Number> numbers = {};
};

}  // namespace machines
