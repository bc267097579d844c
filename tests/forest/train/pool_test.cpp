#include "surefoot/forest/train/pool.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <vector>

#include "surefoot/core/executor.hpp"

namespace surefoot {
namespace {

TEST_CASE("what is given back is used again, as it was left") {
  detail::Pool<std::vector<int>> pool;
  const std::vector<int>* first = nullptr;
  {
    const auto borrowed = pool.borrow();
    first = borrowed.get();
    borrowed->push_back(3);
  }
  const auto again = pool.borrow();
  CHECK(again.get() == first);
  CHECK(*again == std::vector<int>{3});
  CHECK(pool.borrow()->empty());  // the other is in use
}

TEST_CASE("two jobs never share a thing, and no more are made than jobs run at once") {
  struct Thing {
    std::atomic<int> users{0};
    int uses = 0;
  };
  detail::Pool<Thing> pool;
  const std::vector<int> uses = map(Threads(4), 2000, [&](std::size_t) {
    const auto thing = pool.borrow();
    const bool alone = thing->users.fetch_add(1) == 0;
    ++thing->uses;
    thing->users.fetch_sub(1);
    return alone ? 1 : 0;
  });
  CHECK(std::count(uses.begin(), uses.end(), 1) == 2000);
  std::vector<decltype(pool.borrow())> all;
  int total = 0;
  while (total < 2000 && all.size() < 4) total += all.emplace_back(pool.borrow())->uses;
  CHECK(total == 2000);
}

}  // namespace
}  // namespace surefoot
