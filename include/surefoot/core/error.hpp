// The error types of the whole library.
#pragma once

#include <stdexcept>

namespace surefoot {

/// Base of one error type per area. The message is one sentence that names the place (file, field, argument) and the
/// cure.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Wrong bounds, shapes or counts handed to the core area.
struct CoreError : Error {
  using Error::Error;
};

/// Wrong samples, options or forest files.
struct ForestError : Error {
  using Error::Error;
};

/// Wrong starts, bounds, options or values handed to the optimize area.
struct OptimizeError : Error {
  using Error::Error;
};

/// Wrong sequences, models or options handed to the motion area.
struct MotionError : Error {
  using Error::Error;
};

/// Wrong options, files or problems handed to the solve area.
struct SolveError : Error {
  using Error::Error;
};

/// Wrong models, recordings or options handed to the diagnosis.
struct DiagnoseError : Error {
  using Error::Error;
};

}  // namespace surefoot
