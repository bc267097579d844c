// Questions about the items of a list, and changes of lists, as plain loops: the same as the algorithms and members of
// the standard library they are named after, which cost the compiler five times as much for each kind of item (about
// 1 MB instead of 0.2 MB a call, or 4 MB for `insert`).
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace surefoot::diagnosis {

/// Whether the condition holds for at least one item (std::any_of).
template <class Items, class Condition>
bool holds_for_any(const Items& items, const Condition& condition) {
  for (const auto& item : items) {
    if (condition(item)) return true;
  }
  return false;
}

/// Whether the condition holds for every item (std::all_of).
template <class Items, class Condition>
bool holds_for_all(const Items& items, const Condition& condition) {
  for (const auto& item : items) {
    if (!condition(item)) return false;
  }
  return true;
}

/// How many items the condition holds for (std::count_if).
template <class Items, class Condition>
std::ptrdiff_t count_items(const Items& items, const Condition& condition) {
  std::ptrdiff_t count = 0;
  for (const auto& item : items) count += condition(item) ? 1 : 0;
  return count;
}

/// The first item the condition holds for, or none (std::find_if).
template <class Items, class Condition>
auto find_item(Items& items, const Condition& condition) -> decltype(items.data()) {
  for (auto& item : items) {
    if (condition(item)) return &item;
  }
  return nullptr;
}

/// Removes the items the condition holds for, and returns how many they were (std::erase_if).
template <class Item, class Condition>
std::size_t drop_items(std::vector<Item>& items, const Condition& condition) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (condition(items[i])) continue;
    if (kept != i) items[kept] = std::move(items[i]);
    ++kept;
  }
  const std::size_t dropped = items.size() - kept;
  for (std::size_t i = 0; i < dropped; ++i) items.pop_back();
  return dropped;
}

/// Moves the items the condition holds for before the others, each in their order (std::stable_partition).
template <class Item, class Condition>
void put_first(std::vector<Item>& items, const Condition& condition) {
  std::vector<Item> sorted;
  sorted.reserve(items.size());
  std::vector<bool> first(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) first[i] = condition(items[i]);
  for (const bool now : {true, false}) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (first[i] == now) sorted.push_back(std::move(items[i]));
    }
  }
  items = std::move(sorted);
}

/// Puts an item before the one at a place (std::vector::insert).
template <class Item>
void insert_item(std::vector<Item>& items, std::size_t place, Item item) {
  items.push_back(std::move(item));
  for (std::size_t i = items.size() - 1; i > place; --i) std::swap(items[i], items[i - 1]);
}

/// Adds copies of other items at the end (std::vector::insert); moved there, as most vectors are filled, so that each
/// is compiled for that alone.
template <class Item>
void append_items(std::vector<Item>& items, const std::vector<Item>& others) {
  for (const Item& other : others) items.push_back(Item(other));
}

}  // namespace surefoot::diagnosis
