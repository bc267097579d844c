// Tests of surefoot/diagnose/estimation/items.hpp.
#include "surefoot/diagnose/estimation/items.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "surefoot/core/rng.hpp"

namespace surefoot::diagnosis {

TEST_CASE("questions about lists and changes of them are those of the standard library") {
  Rng rng(1);
  const auto small = [](int item) { return item < 3; };
  for (std::size_t count = 0; count < 60; ++count) {
    std::vector<int> items;
    for (std::size_t i = 0; i < count % 12; ++i) items.push_back(static_cast<int>(rng.below(6)));
    const auto begin = items.begin(), end = items.end();
    CHECK(holds_for_any(items, small) == std::any_of(begin, end, small));
    CHECK(holds_for_all(items, small) == std::all_of(begin, end, small));
    CHECK(count_items(items, small) == std::count_if(begin, end, small));
    const auto first = std::find_if(begin, end, small);
    const int* const found = find_item(items, small);
    CHECK((first == end ? found == nullptr : found == &*first));

    std::vector<int> sorted = items, expected = items;
    put_first(sorted, small);
    std::stable_partition(expected.begin(), expected.end(), small);
    CHECK(sorted == expected);

    std::vector<int> left = items;
    expected = items;
    const std::size_t dropped = drop_items(left, small);
    CHECK(dropped == std::erase_if(expected, small));
    CHECK(left == expected);

    append_items(left, items);
    expected.insert(expected.end(), items.begin(), items.end());
    CHECK(left == expected);
    const std::size_t place = left.size() / 2;
    insert_item(left, place, 7);
    expected.insert(expected.begin() + static_cast<std::ptrdiff_t>(place), 7);
    CHECK(left == expected);
  }
}

}  // namespace surefoot::diagnosis
