// Faults of walks, and the names that walks use.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "plant.hpp"

namespace plants {

using Triple = std::array<double, 3>;  // forward [m], lateral [m], turn [rad]; or a pose in the plane

inline constexpr Triple top_order{0.08, 0.04, 0.3};  // largest orders

inline const std::vector<std::string> axes{"forward", "lateral", "turn"};
inline const std::vector<std::string> order_names{"ox", "oy", "ot"};
inline const std::vector<std::string> order_columns{"order_x_m", "order_y_m", "order_turn_rad"};
inline const std::vector<std::string> pose_columns{"x_m", "y_m", "th_rad"};
inline const std::vector<std::string> pose_states{"x", "y", "th"};

Fault draw_walk_fault(Random& random, const System& system);
Fault draw_outside_walk_fault(Random& random);

}  // namespace plants
