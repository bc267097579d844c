// What a program prints for --version.
#pragma once

#include <string>

#include "surefoot/version.hpp"

namespace example {

/// "surefoot-diagnose 1.2.3".
inline std::string version_text(const std::string& program) {
  return program + ' ' + std::to_string(SUREFOOT_VERSION_MAJOR) + '.' + std::to_string(SUREFOOT_VERSION_MINOR) + '.' +
         std::to_string(SUREFOOT_VERSION_PATCH);
}

}  // namespace example
