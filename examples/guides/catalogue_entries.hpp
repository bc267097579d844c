// What the catalogue says of each effect beyond what the effect says of itself: its formula, the mark it leaves, and
// the numbers with which it is drawn.
#pragma once

#include <string>
#include <vector>

namespace catalogue {

/// One form of an effect. In formulas q is the position, v its speed, F a force, u an input, y a reading, d the
/// displacement of a step.
struct Form {
  std::string name;  // that of the effect
  std::string form;  // mostly empty
  std::string formula;
  std::vector<double> values = {};  // drawn with these, in the order of the parameters; empty: this form is not drawn
  std::string mark = {};            // of the first form: what shows in the residual
};

inline std::vector<Form> forms() {
  return {
      // on the displacement of a step
      {"slip_saturation",
       "forward",
       "d = level tanh(d / level), d the forward part",
       {0.05},
       "large steps fall short, small ones do not"},
      {"slip_saturation", "lateral", "the same for the lateral part"},
      {"slip_saturation", "turn", "the same for the turn"},
      {"body_drift",
       "",
       "d = d + (forward, lateral, turn), in the frame of the body",
       {0.002, 0.001, 0.008},
       "an error that turns with the robot and grows with the number of steps, whatever was commanded"},
      {"ground_slope",
       "",
       "d = d + R(-heading) (x, y), the same in the frame of the world",
       {0.003, 0.001},
       "an error in one direction of the room, whatever the heading"},
      {"ground_slope", "distance", "d = d + |d| R(-heading) (x, y)"},
      {"cross_coupling",
       "forward_to_turn",
       "turn = turn + gain forward",
       {0.6},
       "an error of one part of the step in proportion to another part, of either sign"},
      {"cross_coupling", "forward_to_lateral", "lateral = lateral + gain forward"},
      {"cross_coupling", "lateral_to_turn", "turn = turn + gain lateral"},
      {"cross_coupling", "lateral_to_forward", "forward = forward + gain lateral"},
      {"cross_coupling", "turn_to_forward", "forward = forward + gain turn"},
      {"cross_coupling", "turn_to_lateral", "lateral = lateral + gain turn"},

      // on a velocity
      {"viscous_friction",
       "",
       "F = -damping v",
       {0.03},
       "in phase with the speed: swings come out smaller, and ring less"},
      {"coulomb_friction",
       "",
       "F = -level sign(v); at rest up to level, whatever holds it there",
       {0.03},
       "jumps where the motion reverses; after small steps it rests beside where it should"},
      {"coulomb_friction", "presliding",
       "the same, reached after width of travel: F = -force z / width, z' = v - |v| z / width"},
      {"stribeck_friction",
       "",
       "F = -(level + breakaway exp(-(v / speed)^2)) sign(v); at rest up to level + breakaway",
       {0.02, 0.03, 0.3},
       "as dry friction, and longer rests: it sticks, then slips"},
      {"stribeck_friction", "tailed", "the same with exp(-|v / speed|^exponent)"},
      {"load_dependent_friction",
       "drive",
       "dry friction of factor |drive|, the force due to the inputs",
       {0.2},
       "jumps at reversals that are larger the harder it pushes"},
      {"load_dependent_friction", "load",
       "dry friction of factor |load|, the force that remains with inputs and speed at zero"},
      {"load_dependent_friction", "gears", "dry friction of factor |drive - load| / 2"},
      {"load_dependent_friction", "drive, presliding", "the same as drive, times z / width of hysteresis"},
      {"load_dependent_friction", "load, presliding", "the same as load, times z / width of hysteresis"},
      {"load_dependent_friction", "gears, presliding", "the same as gears, times z / width of hysteresis"},
      {"quadratic_drag",
       "",
       "F = -drag v |v|",
       {0.04},
       "as viscous friction, but only the fast parts of the motion fall short"},
      {"constant_force", "", "F = force", {0.03}, "an offset to one side wherever it rests"},
      {"cubic_stiffness", "", "F = -stiffness q^3", {0.8}, "only large deflections fall short"},
      {"hysteresis",
       "",
       "F = -force z / width, z' = v - |v| z / width",
       {0.03, 0.1},
       "depends on the way and not on the speed: after each reversal it builds up over the width"},
      {"hysteresis", "n = 2", "F = -force z / width, dz/dq = 1 - (z / width)^2 on the way out, 1 on the way back"},
      {"hysteresis", "asymmetric",
       "F = -force z / width, dz/dq = 1 - (1 - shape) |z| / width on the way out, 1 + (1 + shape) |z| / width on the "
       "way back"},
      {"backlash",
       "",
       "equations see min(max(seen, q - half_width), q + half_width)",
       {0.03},
       "motion lost at each reversal, by the same amount whatever the amplitude"},
      {"backlash", "gap",
       "a load of ratio times the inertia, behind a gap of half_width either way; it swings at frequency in contact"},
      {"backlash", "motor",
       "drive acts on motor_inertia before the gap, what is seen is behind it; rigid parts, impacts"},
      {"backlash", "sensor", "y = min(max(last y, y - half_width), y + half_width)"},
      {"joint_elasticity",
       "",
       "a second inertia, ratio times the first, behind a spring and a damper; they swing against each other at "
       "frequency",
       {0.3, 25, 0.05},
       "ringing of a fixed frequency after each jolt"},
      {"cogging",
       "",
       "F = sine sin(2 pi q / period) + cosine cos(2 pi q / period)",
       {0.03, 0, 0.2},
       "ripples at fixed positions, whichever way it moves"},
      {"gravity_offset",
       "",
       "F = weight cos(q)",
       {0.03},
       "an offset that is largest where the arm hangs, and vanishes at a quarter turn"},
      {"end_stop",
       "upper",
       "q is at most level; there v becomes -restitution v",
       {0.35, 0.3},
       "the top of each swing is cut off, with a bounce"},
      {"end_stop", "lower", "q is at least level; there v becomes -restitution v"},
      {"end_stop", "upper, elastic", "F = -stiffness max(q - level + settling v, 0) where q > level"},
      {"end_stop", "lower, elastic", "F = stiffness max(level - q - settling v, 0) where q < level"},

      // on a state
      {"leak", "", "rate = rate - leak x", {0.03}, "the more there is, the more is missing; it decays too quickly"},
      {"leak", "hole", "rate = rate - rate_at_one sqrt(max(x, 0))"},
      {"constant_rate", "", "rate = rate + rate", {0.008}, "an offset that does not care how much there is"},
      {"overflow", "", "x is at most level", {0.35}, "the top is cut off, and what was lost is missing afterwards"},
      {"overflow", "spill", "x is at most level; share of what exceeds it is added to another state"},

      // on an input
      {"input_gain", "", "u = u (1 + excess)", {-0.2}, "all motions too small or too large by the same share"},
      {"input_asymmetry",
       "",
       "u = u (1 + asymmetry) for u > 0, u (1 - asymmetry) for u < 0",
       {0.25},
       "too much to one side, too little to the other"},
      {"dead_zone",
       "",
       "u = sign(u) max(|u| - width, 0)",
       {0.04},
       "small commands do nothing, all others fall short by the same amount"},
      {"dead_zone", "step", "u = u where |u| > width, else 0 (the edge softened over a fifth of the width)"},
      {"saturation", "", "u = min(max(u, -level), level)", {0.14}, "only the largest commands fall short"},
      {"saturation", "soft", "u = level tanh(u / level)"},
      {"saturation", "gradual", "u = u / (1 + |u / level|^sharpness)^(1 / sharpness)"},
      {"rate_limit",
       "",
       "u follows its command by at most rate per second",
       {1},
       "late after large steps, in time after small ones"},
      {"rate_limit", "from rest", "the same, from 0 at the first row on, and not from its first command"},
      {"input_delay", "", "u(t - delay)", {0.05}, "a copy of the motion's slope: late everywhere by the same time"},
      {"input_delay", "from rest", "the same, 0 until the first command arrives"},
      {"first_order_lag", "", "time u' = command - u", {0.08}, "late after sharp steps, and their corners rounded"},
      {"first_order_lag", "from rest", "the same, from 0 at the first row on, and not from its first command"},
      {"supply_sag", "", "u = u (1 - sag |u|), not below 0", {1}, "falls short with the square of the command"},

      // in a sensor
      {"sensor_bias", "", "y = y + bias", {0.03}, "a constant, from the first row on"},
      {"sensor_scale", "", "y = y (1 + excess)", {0.1}, "a copy of the reading itself"},
      {"sensor_delay", "", "y(t - delay)", {0.03}, "a copy of the reading's slope"},
      {"sensor_drift", "", "y = y + rate t", {0.01}, "a ramp, whatever the machine does"},
      {"sensor_drift", "settling", "y = y + change (1 - exp(-t / time))"},
      {"quantization",
       "",
       "y = step round(y / step), soft edges",
       {0.12},
       "a saw tooth of one step, which follows the reading"},
      {"quantization", "floor", "y = step floor(y / step), soft edges"},

      // in a parameter
      {"parameter_drift",
       "",
       "p = p (1 + rate t), not below p / 20",
       {0.05},
       "an error that grows during each recording, in proportion to the motion"},
      {"parameter_drift", "settling", "p = p (1 + change (1 - exp(-t / time))), not below p / 20"},
  };
}

}  // namespace catalogue
