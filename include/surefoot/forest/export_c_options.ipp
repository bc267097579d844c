// Definitions of surefoot/forest/export_c_options.hpp.
#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/export_c_options.hpp"

namespace surefoot {

SUREFOOT_ONCE void check(const ExportCOptions& options, int outputs) {
  const std::string& name = options.function;
  const auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), letter) ||
      std::isdigit(static_cast<unsigned char>(name[0])) != 0) {
    throw ForestError("ExportCOptions: function must be a name in C, got \"" + name + "\"");
  }
  if (options.whole_outputs && (options.thresholds == CThreshold::float32 || options.descent != CDescent::tables)) {
    throw ForestError("ExportCOptions: whole_outputs needs thresholds int16 or int32 and descent tables");
  }
  const auto count = static_cast<std::size_t>(outputs);
  bool right = options.low.size() == options.high.size() && (options.low.empty() || options.low.size() == count);
  for (std::size_t i = 0; right && i < options.low.size(); ++i) {
    right = std::isfinite(options.low[i]) && std::isfinite(options.high[i]) && options.low[i] <= options.high[i];
  }
  if (!options.agreement.empty() && options.agreement.size() != count) {
    throw ForestError("ExportCOptions: agreement must be empty or hold " + std::to_string(count) +
                      " numbers, one per output");
  }
  if (!right) {
    throw ForestError("ExportCOptions: low and high must be empty or hold " + std::to_string(count) +
                      " finite numbers each, one per output, low not above high");
  }
}

}  // namespace surefoot
