// Numbers of result files.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace diagnose_program {

/// JSON knows neither infinities nor "not a number": those become null.
inline nlohmann::ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace diagnose_program
