// The root of every exception this library throws on purpose.
#pragma once

#include <stdexcept>

namespace surefoot {

/// Base of one exception type per area (CoreError, ForestError, ...). The message is one sentence that names the
/// place (file, field, argument) and the cure.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Wrong bounds, shapes or counts handed to the core area.
struct CoreError : Error {
  using Error::Error;
};

}  // namespace surefoot
