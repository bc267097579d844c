// Backlash: a gap between two parts, of which one moves the other only at either end of it.
// M. Nordin, P.-O. Gutman: "Controlling mechanical systems with backlash - a survey", Automatica 38, 2002. The gap
// operator: M. A. Krasnosel'skii, A. V. Pokrovskii: "Systems with hysteresis", 1989, section 2.
// Forms: "" - the equations see the position through the gap; "gap" - a second inertia is coupled through a stiff
// spring that engages at either end of the gap; "motor" - the drive acts on an inertia before the gap, and what the
// equations and the sensor see is behind it; "sensor" - the sensor sees its quantity through the gap; "coupling" - a
// force that the equations have between two bodies acts at either end of the gap only. Confusable with a delay (at one
// amplitude and frequency), with dry friction and hysteresis, which also lose motion at each reversal, and with
// elasticity, which gives way but without a gap.
#pragma once

#include <algorithm>

#include "surefoot/diagnose/effects/dead_zone.hpp"
#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/detail/motor_behind_backlash.hpp"
#include "surefoot/diagnose/effects/detail/two_masses.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// Where a part ends that is moved by `driver` through a gap of half_width, and was at `driven`.
inline double behind_gap(double driven, double driver, double half_width) {
  return std::min(std::max(driven, driver - half_width), driver + half_width);
}

/// Hidden states: the position behind the gap.
[[gnu::cold]] inline Effect backlash() {
  return {.name = "backlash",
          .sentence = "backlash of {half_width} to either side at {at}",
          .place = Place::velocity,
          .parameters = parameters_of({{.name = "half_width",
                                        .measure = {.position = 1},
                                        .low = 0,
                                        .high = 1,
                                        .starts = {0.003, 0.02, 0.1},
                                        .strength = true}}),
          .confusable_with =
              names_of({"input_delay", "sensor_delay", "hysteresis", "coulomb_friction", "joint_elasticity"}),
          .experiment = "slow reversals at two amplitudes: lost motion is the same for both",
          .hidden_states = 1,
          .start_measure = Measure{.position = 1},
          .start = +[](const EffectContext& m, Values, HiddenStates hidden) { hidden[0] = m.position; },
          .advance = +[](const EffectContext& m, Values p,
                         HiddenStates hidden) { hidden[0] = behind_gap(hidden[0], m.position, p[0]); },
          .seen_position =
              +[](const EffectContext& m, Values p, Values hidden) { return behind_gap(hidden[0], m.position, p[0]); }};
}

inline TwoMasses gap_joint(Values p) {
  return TwoMasses{.ratio = p[0], .frequency = p[2], .damping = p[3], .half_width = p[1]};
}

[[gnu::cold]] inline Effect backlash_gap() {
  return {.name = "backlash",
          .sentence = "a load of {ratio} times the inertia behind backlash of {half_width} to either side at {at}",
          .place = Place::velocity,
          .parameters = parameters_of(
              {{.name = "ratio", .measure = {}, .low = 0, .high = 10, .starts = {0.01}, .strength = true},
               {.name = "half_width", .measure = {.position = 1}, .low = 0.001, .high = 1, .starts = {0.02, 0.05, 0.1}},
               {.name = "frequency",  // of the two inertias in contact [rad/s]
                .measure = {.time = -1},
                .low = 15,
                .high = 600,  // about half a turn per row: no faster one is seen
                .starts = {40, 90}},
               {.name = "damping",  // share of the critical one, of the contact
                .measure = {},
                .low = 0.02,
                .high = 1,
                .starts = {0.2}}}),
          .confusable_with = names_of({"joint_elasticity", "hysteresis", "input_delay"}),
          .experiment = "quick reversals at two amplitudes, small ones inside the gap",
          .form = "gap",
          .hidden_states = 3,
          .force = +[](const EffectContext& m, Values p, Values hidden) { return force_of(gap_joint(p), m, hidden); },
          .start = +[](const EffectContext& m, Values, HiddenStates hidden) { start(m, hidden); },
          .advance = +[](const EffectContext& m, Values p, HiddenStates hidden) { advance(gap_joint(p), m, hidden); }};
}

/// Rigid parts (see motor_behind_backlash.hpp). The inertia of the equations is that of both.
[[gnu::cold]] inline Effect backlash_motor() {
  return {.name = "backlash",
          .sentence = "a motor of inertia {motor_inertia} before backlash of {half_width} to either side at {at}",
          .place = Place::velocity,
          .parameters = parameters_of({{.name = "half_width",
                                        .measure = {.position = 1},
                                        .low = 0,
                                        .high = 1,
                                        .starts = {0.01, 0.02, 0.04, 0.09},
                                        .strength = true},
                                       {.name = "motor_inertia",
                                        .measure = {.effort = 1, .rate = -1},
                                        .low = 0.05,
                                        .high = 2,
                                        .starts = {0.25, 0.45, 0.65, 0.9}}}),
          .confusable_with = names_of({"first_order_lag", "joint_elasticity", "input_delay", "hysteresis"}),
          .experiment = "slow reversals at two amplitudes: lost motion is the same for both",
          .form = "motor",
          .hidden_states = 4,
          .needs_load = true,
          .needs_damping = true,
          .is_impulsive = true,
          .force =
              +[](const EffectContext& m, Values p, Values hidden) {
                return MotorBehindBacklash{p[0], p[1]}.force(m, hidden);
              },
          .position_rate =
              +[](const EffectContext& m, Values p, Values hidden) {
                return MotorBehindBacklash{p[0], p[1]}.position_rate(m, hidden);
              },
          .hidden_rate =
              +[](const EffectContext& m, Values p, Values hidden, HiddenStates rates) {
                const Offset mean = MotorBehindBacklash{p[0], p[1]}.mean_rates(m, hidden);
                rates[2] = mean.d;
                rates[3] = mean.w;
              },
          .advance =
              +[](const EffectContext&, Values p, HiddenStates hidden) {
                MotorBehindBacklash{p[0], p[1]}.advance(hidden);
              }};
}

/// A force between two bodies that is not passed on while the parts are within the gap; the gap is as wide as the
/// displacement to which that force belongs.
[[gnu::cold]] inline Effect backlash_coupling() {
  return {.name = "backlash",
          .sentence = "backlash in {at}: nothing is passed on below {force} to either side",
          .place = Place::input,
          .parameters = parameters_of({{.name = "force",
                                        .measure = {.value = 1},
                                        .low = 0,
                                        .high = 2,
                                        .starts = {0.003, 0.05, 0.2, 0.6},
                                        .strength = true}}),
          .confusable_with = names_of({"joint_elasticity", "cubic_stiffness", "hysteresis", "sensor_delay"}),
          .experiment = "slow reversals at two amplitudes: lost motion is the same for both",
          .form = "coupling",
          .needs_coupling = true,
          .signal = +[](const EffectContext& m, Values p, Values) { return beyond_dead_zone(m.value, p[0]); }};
}

[[gnu::cold]] inline Effect backlash_sensor() {
  return {.name = "backlash",
          .sentence = "backlash of {half_width} to either side before the sensor {at}",
          .place = Place::output,
          .parameters = parameters_of({{.name = "half_width",
                                        .measure = {.value = 1},
                                        .low = 0,
                                        .high = 1,
                                        .starts = {0.003, 0.02, 0.1},
                                        .strength = true}}),
          .confusable_with = names_of({"sensor_delay", "quantization", "hysteresis"}),
          .experiment = "slow reversals at two amplitudes, watched by a second sensor",
          .form = "sensor",
          .sensor = +[](const Series& series, Values p) {
            if (series.readings.empty()) return;
            double seen = series.readings[0];
            for (double& reading : series.readings) reading = seen = behind_gap(seen, reading, p[0]);
          }};
}

}  // namespace surefoot::effects
