// Sorting of big items, such as fits: their places are sorted, by code that is compiled once for all kinds of items.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/function_ref.hpp"

namespace surefoot::diagnosis {

/// The places 0 to count - 1 as std::sort puts them.
std::vector<std::size_t> sorted_places(std::size_t count, FunctionRef<bool(std::size_t, std::size_t)> less);

/// Sorts items as std::sort does, equal ones included, but moves each only once.
template <class Item, class Less>
void sort_items(std::vector<Item>& items, const Less& less) {
  const auto before = [&](std::size_t a, std::size_t b) { return less(items[a], items[b]); };
  std::vector<Item> sorted;
  sorted.reserve(items.size());
  for (const std::size_t place : sorted_places(items.size(), before)) sorted.push_back(std::move(items[place]));
  items = std::move(sorted);
}

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/sort_items.ipp"
#endif
