// Definitions of surefoot/motion/noise.hpp.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <tuple>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/noise.hpp"

namespace surefoot {

SUREFOOT_INLINE std::string_view name_of(NoiseGrowth growth) {
  switch (growth) {
    case NoiseGrowth::constant:
      return "constant";
    case NoiseGrowth::with_speed:
      return "proportional to speed";
    case NoiseGrowth::with_speed_and_acceleration:
      return "linear in speed and acceleration";
  }
  return "";
}

}  // namespace surefoot
