// The robot itself, through one walk cycle.
#pragma once

#include <filesystem>

#include "surefoot/core/vec.hpp"
#include "walking_twin.hpp"

namespace sigmaban {

/// Draws BASE.svg and BASE.png: eight moments of the third walk cycle with these commands per step [m, m, rad]. Throws
/// example::UsageError if nothing can be rendered here.
void draw_robot_strip(const std::filesystem::path& base, const WalkingTwinOptions& options,
                      const surefoot::Vec<3>& commands);

}  // namespace sigmaban
