// Backlash: play between two parts, of which one moves the other only at either end of it.
// M. Nordin, P.-O. Gutman: "Controlling mechanical systems with backlash - a survey", Automatica 38, 2002. The play
// operator: M. A. Krasnosel'skii, A. V. Pokrovskii: "Systems with hysteresis", 1989, section 2.
// Forms: "" - the equations see the position through the play; "gap" - a second inertia is coupled through a stiff
// spring that engages at either end of the play; "motor" - the drive acts on an inertia before the play, and what the
// equations and the sensor see is behind it; "sensor" - the sensor sees its quantity through the play.
// Confusable with a delay (at one amplitude and frequency), with dry friction and hysteresis, which also lose motion at
// each reversal, and with elasticity, which gives way but without a gap.
#pragma once

#include <algorithm>

#include "surefoot/diagnose/effect.hpp"
#include "surefoot/diagnose/effects/playing_motor.hpp"
#include "surefoot/diagnose/effects/two_masses.hpp"

namespace surefoot::effects {

/// Where a part ends that is moved by `driver` through a play of half_width, and was at `driven`.
inline double play(double driven, double driver, double half_width) {
  return std::min(std::max(driven, driver - half_width), driver + half_width);
}

/// Memory: the position behind the play.
inline Effect backlash() {
  return {.name = "backlash",
          .sentence = "backlash of {half_width} to either side at {at}",
          .place = Place::velocity,
          .parameters = {{.name = "half_width",
                          .measure = {.position = 1},
                          .low = 0,
                          .high = 1,
                          .starts = {0.003, 0.02, 0.1},
                          .strength = true}},
          .confusable_with = {"input_delay", "sensor_delay", "hysteresis", "coulomb_friction", "joint_elasticity"},
          .experiment = "slow reversals at two amplitudes: lost motion is the same for both",
          .memories = 1,
          .start = [](const Moment& m, Values, Memory memory) { memory[0] = m.position; },
          .advance = [](const Moment& m, Values p, Memory memory) { memory[0] = play(memory[0], m.position, p[0]); },
          .seen_position = [](const Moment& m, Values p, Values memory) { return play(memory[0], m.position, p[0]); }};
}

namespace detail {

inline TwoMasses gap_joint(Values p) {
  return TwoMasses{.ratio = p[0], .frequency = p[2], .damping = 0.2, .half_width = p[1]};
}

}  // namespace detail

/// Damping ratio 0.2 in contact.
inline Effect backlash_gap() {
  return {
      .name = "backlash",
      .sentence = "a load of {ratio} times the inertia behind backlash of {half_width} to either side at {at}",
      .place = Place::velocity,
      .parameters =
          {{.name = "ratio", .measure = {}, .low = 0, .high = 10, .starts = {0.01}, .strength = true},
           {.name = "half_width", .measure = {.position = 1}, .low = 0.001, .high = 1, .starts = {0.02, 0.05, 0.1}},
           {.name = "frequency",  // of the two inertias in contact [rad/s]
            .measure = {.time = -1},
            .low = 15,
            .high = 200,
            .starts = {40, 90}}},
      .confusable_with = {"joint_elasticity", "hysteresis", "input_delay"},
      .experiment = "quick reversals at two amplitudes, small ones inside the play",
      .form = "gap",
      .memories = 3,
      .force = [](const Moment& m, Values p,
                  Values memory) { return detail::force_of(detail::gap_joint(p), m, memory); },
      .start = [](const Moment& m, Values, Memory memory) { detail::start(m, memory); },
      .advance = [](const Moment& m, Values p, Memory memory) { detail::advance(detail::gap_joint(p), m, memory); }};
}

/// Rigid parts (see playing_motor.hpp). The inertia of the equations is that of both.
inline Effect backlash_motor() {
  return {.name = "backlash",
          .sentence = "a motor of inertia {motor_inertia} before backlash of {half_width} to either side at {at}",
          .place = Place::velocity,
          .parameters = {{.name = "half_width",
                          .measure = {.position = 1},
                          .low = 0,
                          .high = 1,
                          .starts = {0.01, 0.02, 0.04, 0.09},
                          .strength = true},
                         {.name = "motor_inertia",
                          .measure = {.effort = 1, .rate = -1},
                          .low = 0.05,
                          .high = 2,
                          .starts = {0.25, 0.45, 0.65, 0.9}}},
          .confusable_with = {"first_order_lag", "joint_elasticity", "input_delay", "hysteresis"},
          .experiment = "slow reversals at two amplitudes: lost motion is the same for both",
          .form = "motor",
          .memories = 4,
          .needs_damping = true,
          .impacts = true,
          .force = [](const Moment& m, Values p,
                      Values memory) { return detail::PlayingMotor{p[0], p[1]}.force(m, memory); },
          .position_rate = [](const Moment& m, Values p,
                              Values memory) { return detail::PlayingMotor{p[0], p[1]}.position_rate(m, memory); },
          .memory_rate =
              [](const Moment& m, Values p, Values memory, Memory rates) {
                const detail::Offset mean = detail::PlayingMotor{p[0], p[1]}.mean_rates(m, memory);
                rates[2] = mean.d;
                rates[3] = mean.w;
              },
          .advance = [](const Moment&, Values p, Memory memory) { detail::PlayingMotor{p[0], p[1]}.advance(memory); }};
}

inline Effect backlash_sensor() {
  return {.name = "backlash",
          .sentence = "backlash of {half_width} to either side before the sensor {at}",
          .place = Place::output,
          .parameters = {{.name = "half_width",
                          .measure = {.value = 1},
                          .low = 0,
                          .high = 1,
                          .starts = {0.003, 0.02, 0.1},
                          .strength = true}},
          .confusable_with = {"sensor_delay", "quantization", "hysteresis"},
          .experiment = "slow reversals at two amplitudes, watched by a second sensor",
          .form = "sensor",
          .sensor = [](const Series& series, Values p) {
            if (series.readings.empty()) return;
            double seen = series.readings[0];
            for (double& reading : series.readings) reading = seen = play(seen, reading, p[0]);
          }};
}

}  // namespace surefoot::effects
