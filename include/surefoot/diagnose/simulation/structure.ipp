// Definitions of surefoot/diagnose/simulation/structure.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/simulation/structure.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE Sizes unit_sizes(const SimulatorInfo& info) {
  Sizes sizes;
  sizes.state.assign(info.states.size(), 1.0);
  sizes.rate = sizes.effort = sizes.position = sizes.state;
  sizes.input.assign(info.inputs.size(), 1.0);
  sizes.signal.assign(info.signals.size(), 1.0);
  sizes.output.assign(info.outputs.size(), 1.0);
  sizes.state_peak = sizes.state;
  sizes.input_peak = sizes.input;
  sizes.signal_peak = sizes.signal;
  return sizes;
}

}  // namespace surefoot::diagnosis
