// Definitions of surefoot/core/rng.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"

namespace surefoot {

SUREFOOT_INLINE std::vector<double> latin_hypercube(std::uint32_t count, std::uint32_t dims, Rng& rng) {
  std::vector<double> points(std::size_t{count} * dims);
  std::vector<std::uint32_t> slices(count);
  for (std::uint32_t d = 0; d < dims; ++d) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t j = rng.below(i + 1);
      slices[i] = slices[j];
      slices[j] = i;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      const double draw = (slices[i] + rng.uniform()) / count;
      points[std::size_t{i} * dims + d] = draw < 1.0 ? draw : 1.0 - 0x1p-53;
    }
  }
  return points;
}

}  // namespace surefoot
