// How example programs fail and stop.
#pragma once

#include "surefoot/core/error.hpp"

namespace example {

/// A file or option that cannot be used, or a program that is missing; the message names it and the cure.
struct UsageError : surefoot::Error {
  using Error::Error;
};

/// Thrown after Ctrl-C, once everything worth keeping is on disk.
struct Interrupted {};

}  // namespace example
