// Tests of surefoot/diagnose/estimation/sort_items.hpp.
#include "surefoot/diagnose/estimation/sort_items.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"

namespace surefoot::diagnosis {

struct Named {
  double key = 0;
  std::string name;
  bool operator==(const Named&) const = default;
};

TEST_CASE("sort_items gives what std::sort gives, equal items included") {
  Rng rng(1);
  for (std::size_t count = 0; count < 200; ++count) {
    std::vector<Named> items;
    for (std::size_t i = 0; i < count; ++i) items.push_back({static_cast<double>(rng.below(20)), std::to_string(i)});
    std::vector<Named> expected = items;
    const auto falling = [](const Named& a, const Named& b) { return a.key > b.key; };
    std::sort(expected.begin(), expected.end(), falling);
    sort_items(items, falling);
    CHECK(items == expected);
  }
}

}  // namespace surefoot::diagnosis
