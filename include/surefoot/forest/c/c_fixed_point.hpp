// Inputs and thresholds as whole numbers in a C file, for controllers without floating point.
//
// Input k is multiplied by a power of two, its scale, and rounded to the nearest whole number; so is each threshold.
// Together that moves a threshold by at most 1 / scale: inputs farther than that from all thresholds reach the same
// leaves as with floats.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/error.hpp"
#include "surefoot/forest/c/c_tables.hpp"
#include "surefoot/forest/export_c_options.hpp"

namespace surefoot::detail {

/// Largest size of a whole number of this kind.
inline double c_limit(CThreshold kind) {
  return kind == CThreshold::int16 ? std::numeric_limits<std::int16_t>::max()
                                   : std::numeric_limits<std::int32_t>::max();
}

/// The scale of each input: the largest power of two that leaves room for `largest` (sizes of the inputs; empty: of the
/// largest thresholds) and keeps all thresholds off the ends, where larger inputs end up.
inline std::vector<double> c_scales(const CTables& tables, int inputs, CThreshold kind,
                                    std::span<const double> largest) {
  const auto count = static_cast<std::size_t>(inputs);
  if (!largest.empty() && largest.size() != count) {
    throw ForestError("ExportCOptions: largest_inputs must be empty or have " + std::to_string(count) +
                      " entries, got " + std::to_string(largest.size()));
  }
  std::vector<double> sizes(largest.begin(), largest.end());
  for (const double size : sizes) {
    if (!(size > 0) || !std::isfinite(size)) {
      throw ForestError("ExportCOptions: largest_inputs must be positive and finite, got " + std::to_string(size));
    }
  }
  sizes.resize(count, 0.0);
  for (std::size_t i = 0; i < tables.thresholds.size(); ++i) {
    double& size = sizes[static_cast<std::size_t>(tables.inputs[i])];
    size = std::max(size, std::abs(static_cast<double>(tables.thresholds[i])));
  }
  for (double& size : sizes) {
    const double scale = (c_limit(kind) - 1) / (size > 0 ? size : 1.0);
    size = std::ldexp(1.0, std::clamp(std::ilogb(scale), -120, 120));  // its inverse is a float, too
  }
  return sizes;
}

inline std::int32_t c_fixed(float threshold, double scale) {
  return static_cast<std::int32_t>(std::lround(static_cast<double>(threshold) * scale));
}

inline std::vector<std::int32_t> c_fixed_thresholds(const CTables& tables, std::span<const double> scales) {
  std::vector<std::int32_t> fixed;
  for (std::size_t i = 0; i < tables.thresholds.size(); ++i) {
    fixed.push_back(c_fixed(tables.thresholds[i], scales[static_cast<std::size_t>(tables.inputs[i])]));
  }
  return fixed;
}

}  // namespace surefoot::detail
