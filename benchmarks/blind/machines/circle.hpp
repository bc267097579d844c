// The angle of a whole turn.
#pragma once

#include <numbers>

namespace machines {

inline constexpr double circle = 2 * std::numbers::pi;  // [rad]

}  // namespace machines
