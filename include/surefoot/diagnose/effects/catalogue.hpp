// Catalogue of every effect that the library knows, by where it attaches. Effects of a user's own are values of the
// same type, appended to these.
#pragma once

#include <vector>

#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot {

/// Forces on the speed of something.
std::vector<Effect> velocity_effects();

/// On the rate of any state.
std::vector<Effect> state_effects();

/// On the way of an input to the machine.
std::vector<Effect> input_effects();

/// In a sensor.
std::vector<Effect> sensor_effects();

/// On the displacement of each step in the plane.
std::vector<Effect> planar_effects();

/// On the parameters of the simulator.
std::vector<Effect> parameter_effects();

/// All of them, the more plausible first where two have the same signature.
std::vector<Effect> all_effects();

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/effects/catalogue.ipp"
#endif
