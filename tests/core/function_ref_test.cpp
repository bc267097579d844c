// Tests of surefoot/core/function_ref.hpp.
#include "surefoot/core/function_ref.hpp"

#include <doctest/doctest.h>

#include <functional>

namespace surefoot {

int twice_by(FunctionRef<int(int)> function, int value) { return function(function(value)); }

TEST_CASE("a FunctionRef calls the function object it refers to, not a copy") {
  int calls = 0;
  const auto next = [&calls](int value) { return value + ++calls; };
  CHECK(twice_by(next, 10) == 13);
  CHECK(calls == 2);
  struct Counter {
    mutable int calls = 0;
    int operator()(int value) const { return value * ++calls; }
  };
  const Counter counter;
  CHECK(twice_by(counter, 5) == 10);
  CHECK(counter.calls == 2);
}

TEST_CASE("a copy of a FunctionRef, and a std::function of it, call the same") {
  int seen = 0;
  const auto see = [&seen](int value) { seen += value; };
  const FunctionRef<void(int)> first = see;
  FunctionRef<void(int)> second = first;
  const FunctionRef<void(int)> third = second;
  const std::function<void(int)> kept = third;
  first(1);
  second(10);
  third(100);
  kept(1000);
  CHECK(seen == 1111);
}

}  // namespace surefoot
