// Definitions of surefoot/diagnose/estimation/sort_items.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::vector<std::size_t> sorted_places(std::size_t count,
                                                     FunctionRef<bool(std::size_t, std::size_t)> less) {
  std::vector<std::size_t> places(count);
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::sort(places.begin(), places.end(), [&less](std::size_t a, std::size_t b) { return less(a, b); });
  return places;
}

}  // namespace surefoot::diagnosis
