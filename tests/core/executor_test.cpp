#include "surefoot/core/executor.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <latch>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "surefoot/core/any_executor.hpp"
#include "surefoot/core/rng.hpp"

namespace surefoot {
namespace {

template <std::size_t N>
struct FixedThreads : Threads {
  FixedThreads() : Threads(N) {}
};

struct AnyThreads : AnyExecutor {
  AnyThreads() : AnyExecutor(std::make_unique<Threads>(3)) {}
};

// What every executor must do: a new one joins this list.
#define EXECUTORS Serial, FixedThreads<1>, FixedThreads<2>, FixedThreads<4>, Threads, AnyThreads

TEST_CASE_TEMPLATE("an executor runs every job exactly once", E, EXECUTORS) {
  static_assert(Executor<E>);
  const E executor;
  CHECK(executor.width() >= 1);
  for (const std::size_t count : {0U, 1U, 3U, 1000U}) {
    std::vector<std::atomic<int>> runs(count);
    CHECK(executor.run(count, [&](std::size_t i) { ++runs[i]; }));
    for (const auto& n : runs) CHECK(n == 1);
  }
}

TEST_CASE_TEMPLATE("map collects the results in index order, the same bits from every executor", E, EXECUTORS) {
  const auto job = [](std::size_t i) { return Rng(1, i).normal(); };
  const std::vector<double> results = map(E(), 500, job);
  REQUIRE(results.size() == 500);
  for (std::size_t i = 0; i < results.size(); ++i) CHECK(results[i] == job(i));
}

TEST_CASE_TEMPLATE("map takes results that can only be moved", E, EXECUTORS) {
  const auto results = map(E(), 3, [](std::size_t i) { return std::make_unique<std::size_t>(i); });
  CHECK(*results[2] == 2);
}

TEST_CASE_TEMPLATE("nothing runs when the stop was requested before", E, EXECUTORS) {
  std::stop_source source;
  source.request_stop();
  std::atomic<int> runs = 0;
  CHECK_FALSE(E().run(
      100, [&](std::size_t) { ++runs; }, source.get_token()));
  CHECK(runs == 0);
  CHECK_THROWS_AS(map(
                      E(), 100, [](std::size_t i) { return i; }, source.get_token()),
                  CoreError);
}

TEST_CASE_TEMPLATE("after a stop in mid-run only the jobs at work are finished", E, EXECUTORS) {
  const E executor;
  std::stop_source source;
  std::atomic<std::size_t> runs = 0;
  std::atomic<std::size_t> late = 0;
  const auto job = [&](std::size_t) {
    if (source.stop_requested()) ++late;
    if (++runs >= 10) source.request_stop();
  };
  CHECK_FALSE(executor.run(100'000, job, source.get_token()));
  CHECK(late < executor.width());
}

TEST_CASE_TEMPLATE("a stop requested by the last job comes too late to matter", E, EXECUTORS) {
  std::stop_source source;
  CHECK(E().run(
      1, [&](std::size_t) { source.request_stop(); }, source.get_token()));
}

TEST_CASE_TEMPLATE("an exception of a job stops the others and reaches the caller", E, EXECUTORS) {
  const E executor;
  std::atomic<std::size_t> runs = 0;
  const auto job = [&](std::size_t i) {
    ++runs;
    if (i >= 5) throw std::runtime_error("job " + std::to_string(i));
  };
  CHECK_THROWS_WITH_AS(executor.run(100'000, job), "job 5", std::runtime_error);
  CHECK(runs <= 5 + executor.width());
}

TEST_CASE_TEMPLATE("an executor may be used inside its own job", E, EXECUTORS) {
  const E executor;
  const auto sums = map(executor, 4, [&](std::size_t i) {
    const auto inner = map(executor, 10, [&](std::size_t j) { return i * j; });
    return std::accumulate(inner.begin(), inner.end(), std::size_t{0});
  });
  CHECK(sums == std::vector<std::size_t>{0, 45, 90, 135});
}

TEST_CASE("of several exceptions at once the one of the lowest index is rethrown") {
  std::latch all_at_work(3);
  const auto job = [&](std::size_t i) {
    all_at_work.arrive_and_wait();
    throw std::runtime_error(std::to_string(i));
  };
  CHECK_THROWS_WITH_AS(Threads(3).run(3, job), "0", std::runtime_error);
}

TEST_CASE("Threads runs as many jobs at once as it is wide") {
  std::latch all_at_work(3);
  CHECK(Threads(3).run(3, [&](std::size_t) { all_at_work.arrive_and_wait(); }));
  CHECK(Threads(3).width() == 3);
}

}  // namespace
}  // namespace surefoot
