// From where a joint is to where it should be, without a jump.
#pragma once

#include <algorithm>

#include "../bus/transport.hpp"

namespace dynamixel {

/// The goal that a joint gets: the measured angle at first, the wanted one after `duration_s`, and in between a mean
/// whose weight has no jump in its speed.
struct SoftStart {
  Time begin{};
  double from_rad = 0;
  double duration_s = 0;

  double operator()(double wanted_rad, Time now) const {
    if (duration_s <= 0) return wanted_rad;
    const double share = std::clamp(to_seconds(now - begin) / duration_s, 0.0, 1.0);
    const double weight = share * share * (3 - 2 * share);
    return from_rad + weight * (wanted_rad - from_rad);
  }
};

}  // namespace dynamixel
