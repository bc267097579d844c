// Definitions of surefoot/optimize/rank_noise.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/optimize/rank_noise.hpp"

namespace surefoot {

SUREFOOT_INLINE double rank_disorder(std::span<const double> first, std::span<const double> second) {
  const auto ranks = [](std::span<const double> values) {
    std::vector<std::size_t> order(values.size()), rank(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto value = [&](std::size_t i) {
      return std::isfinite(values[i]) ? values[i] : std::numeric_limits<double>::infinity();
    };
    std::ranges::sort(
        order, [&](std::size_t a, std::size_t b) { return value(a) < value(b) || (value(a) == value(b) && a < b); });
    for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
    return rank;
  };
  const std::vector<std::size_t> a = ranks(first), b = ranks(second);
  double change = 0;
  for (std::size_t i = 0; i < a.size(); ++i) change += std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
  const auto count = static_cast<double>(a.size());
  return change / ((count * count - 1) / 3);
}

}  // namespace surefoot
