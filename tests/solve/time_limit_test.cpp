#include "surefoot/solve/time_limit.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <limits>
#include <stop_token>
#include <thread>

namespace surefoot::detail {
namespace {

TEST_CASE("a limit in time requests a stop when it is up, and says that it did") {
  const TimeLimit limit({}, 0.01);
  const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!limit.token().stop_requested() && std::chrono::steady_clock::now() < late) std::this_thread::yield();
  CHECK(limit.token().stop_requested());
  CHECK(limit.struck());
}

TEST_CASE("a stop from outside is passed on at once, and is not the clock's") {
  std::stop_source source;
  const TimeLimit limit(source.get_token(), std::numeric_limits<double>::infinity());
  CHECK(!limit.token().stop_requested());
  source.request_stop();
  CHECK(limit.token().stop_requested());
  CHECK(!limit.struck());
}

}  // namespace
}  // namespace surefoot::detail
