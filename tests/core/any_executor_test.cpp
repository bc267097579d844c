// An executor behind AnyExecutor does what it does by itself; see executor_test.cpp for what every executor must do.
#include "surefoot/core/any_executor.hpp"

#include <doctest/doctest.h>

#include <memory>
#include <vector>

namespace surefoot {
namespace {

// Two processes in one: odd jobs are done by the other one, whose results come as bytes.
struct TwoProcesses {
  std::size_t* carried;

  std::size_t width() const { return 2; }
  std::size_t processes() const { return 2; }
  template <class Job>
  bool run(std::size_t count, Job&& job, std::stop_token stop = {}) const {
    return Serial().run(count, job, stop);
  }
  template <class Job, class Pack, class Unpack>
  bool run_apart(std::size_t count, Job&& job, std::stop_token stop, Pack&& pack, Unpack&& unpack) const {
    const bool done = run(count, job, stop);
    for (std::size_t i = 1; i < count; i += 2) {
      ByteWriter out;
      pack(i, out);
      ByteReader in(out.bytes(), "the other process");
      unpack(i, in);
      ++*carried;
    }
    return done;
  }
};

TEST_CASE("what several processes find is exchanged behind AnyExecutor as well") {
  std::size_t carried = 0;
  const AnyExecutor executor(std::make_unique<TwoProcesses>(&carried));
  static_assert(Distributed<AnyExecutor>);
  CHECK(executor.width() == 2);
  CHECK(executor.processes() == 2);
  const std::vector<double> results = map(executor, 5, [](std::size_t i) { return 0.5 * static_cast<double>(i); });
  CHECK(results == std::vector<double>{0, 0.5, 1, 1.5, 2});
  CHECK(carried == 2);
}

TEST_CASE("an executor of one process has one, and does all jobs itself") {
  const AnyExecutor executor(std::make_unique<Threads>(3));
  CHECK(executor.width() == 3);
  CHECK(executor.processes() == 1);
  CHECK(map(executor, 3, [](std::size_t i) { return i; }) == std::vector<std::size_t>{0, 1, 2});
}

}  // namespace
}  // namespace surefoot
