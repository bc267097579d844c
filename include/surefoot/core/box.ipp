// Definitions of surefoot/core/box.hpp.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include "surefoot/core/box.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"

namespace surefoot::detail {

SUREFOOT_ONCE void check_bounds(std::span<const double> low, std::span<const double> high) {
  if (low.size() != high.size()) throw CoreError("Box: low and high must have the same size");
  for (std::size_t i = 0; i < low.size(); ++i) {
    if (!std::isfinite(low[i]) || !std::isfinite(high[i]) || low[i] > high[i]) {
      throw CoreError("Box: dimension " + std::to_string(i) + " must have finite bounds with low <= high, got [" +
                      std::to_string(low[i]) + ", " + std::to_string(high[i]) + "]");
    }
  }
}

}  // namespace surefoot::detail
