// Text in the format of printf, as a string.
#pragma once

#include <array>
#include <cstdarg>
#include <cstdio>
#include <string>

namespace example {

/// At most 399 characters; what is longer is cut off.
[[gnu::format(printf, 1, 2)]] inline std::string printed(const char* format, ...) {
  std::array<char, 400> line{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line.data(), line.size(), format, arguments);
  va_end(arguments);
  return line.data();
}

}  // namespace example
