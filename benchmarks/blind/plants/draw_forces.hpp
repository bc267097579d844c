// Random forces for a machine with one degree of freedom, in strengths that suit its typical motion.
#pragma once

#include <string>
#include <vector>

#include "plant.hpp"

namespace plants {

/// Typical sizes in the recordings without faults, and the names that attachments use.
struct Typical {
  double effort = 1, speed = 1, position = 1, order = 1;  // root mean squares
  double reach = 1;                                       // largest position from 0
  std::string speed_state, position_state, effort_unit, position_unit, speed_unit;
};

Fault draw_force(Random& random, const Typical& typical, const std::string& name);
Fault draw_outside_force(Random& random, const Typical& typical);

/// Sensor faults common to all families.
Fault draw_sensor(Random& random, const std::string& name, const std::string& column, const std::string& unit,
                  int output, double spread, double noise, double duration);

/// Faults of an order or signal; `size`: its root mean square, `top`: its largest magnitude.
Fault draw_signal(Random& random, const std::string& name, const std::string& attached_to, const std::string& unit,
                  Place place, double size, double top, double time_scale);

}  // namespace plants
