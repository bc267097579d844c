// The error of the motion area.
#pragma once

#include "surefoot/core/error.hpp"

namespace surefoot {

/// Wrong sequences, models or options handed to the motion area.
struct MotionError : Error {
  using Error::Error;
};

}  // namespace surefoot
