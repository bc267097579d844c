// A step repeated until it works: answers are lost, and machines stand still for a moment, too.
#pragma once

#include "transport.hpp"

namespace dynamixel {

inline constexpr int least_tries = 5;  // of a step: one answer in fifty may be lost, and more must not be

/// Until work() is true, at least least_tries times and for at least that long [s]; false where it never is.
template <class ServoBus, class Work>
bool keep_trying(const ServoBus& bus, double at_least_s, Work work) {
  const Time end = bus.port().now() + from_seconds(at_least_s);
  for (int tries = 0; tries < least_tries || bus.port().now() < end; ++tries) {
    if (work()) return true;
  }
  return false;
}

}  // namespace dynamixel
