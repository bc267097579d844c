// Definitions of surefoot/core/validate.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/core/validate.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const ValidateOptions& options) {
  if (std::min(options.runs, options.horizon) < 1) {
    throw CoreError("ValidateOptions: runs and horizon must be at least 1");
  }
}

namespace detail {

SUREFOOT_ONCE std::string text_of(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", number);
  return text;
}

SUREFOOT_ONCE std::string list_of(const double* numbers, std::size_t count) {
  std::string list = "[";
  for (std::size_t i = 0; i < count; ++i) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", numbers[i]);
    list += (i == 0 ? "" : ", ") + std::string(text);
  }
  return list + "]";
}

SUREFOOT_ONCE bool ask_another_thread(bool (*check)(const void*), const void* argument) {
  bool answer = false;
  std::exception_ptr error;
  std::jthread([&] {
    try {
      answer = check(argument);
    } catch (...) {
      error = std::current_exception();
    }
  }).join();
  if (error) std::rethrow_exception(error);
  return answer;
}

}  // namespace detail
}  // namespace surefoot
