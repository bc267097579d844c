// The exception of the forest area.
#pragma once

#include "surefoot/core/error.hpp"

namespace surefoot {

/// Wrong samples, options or forest files.
struct ForestError : Error {
  using Error::Error;
};

}  // namespace surefoot
