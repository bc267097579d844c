#include "surefoot/core/executor.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/mpi/mpi_executor.hpp"

namespace surefoot {
namespace {

// With one thread per process, and with two.
struct OneThread : MpiExecutor {
  OneThread() : MpiExecutor(MPI_COMM_WORLD) {}
};
struct TwoThreads : MpiExecutor {
  TwoThreads() : MpiExecutor(MPI_COMM_WORLD, 2) {}
};
#define EXECUTORS OneThread, TwoThreads

// How often each job ran in all processes together.
template <class E, class Run>
std::vector<int> counted(const E& executor, std::size_t count, Run run) {
  std::vector<std::atomic<int>> own(count);
  run([&](std::size_t i) { ++own[i]; });
  const auto all =
      map(executor, executor.processes(), [&](std::size_t) { return std::vector<int>(own.begin(), own.end()); });
  std::vector<int> sum(count, 0);
  for (const auto& part : all) {
    for (std::size_t i = 0; i < count; ++i) sum[i] += part[i];
  }
  return sum;
}

TEST_CASE_TEMPLATE("run does every job in every process", E, EXECUTORS) {
  static_assert(Executor<E> && Distributed<E>);
  const E executor;
  CHECK(executor.processes() >= 2);
  CHECK(executor.width() >= executor.processes());
  for (const std::size_t count : {0U, 1U, 3U, 500U}) {
    const auto runs = counted(executor, count, [&](auto job) { CHECK(executor.run(count, job)); });
    CHECK(runs == std::vector<int>(count, static_cast<int>(executor.processes())));
  }
}

TEST_CASE_TEMPLATE("what is shared is done once, job i in process i modulo their number", E, EXECUTORS) {
  const E executor;
  for (const std::size_t count : {0U, 1U, 3U, 500U}) {
    const auto runs = counted(executor, count, [&](auto job) { CHECK(fill(executor, count, job, {})); });
    CHECK(runs == std::vector<int>(count, 1));
  }
  const auto ranks = map(executor, 50, [&](std::size_t) { return executor.rank(); });
  for (std::size_t i = 0; i < ranks.size(); ++i) CHECK(ranks[i] == i % executor.processes());
}

TEST_CASE_TEMPLATE("map gives all results to all processes", E, EXECUTORS) {
  const E executor;
  const auto number = [](std::size_t i) { return Rng(1, i).normal(); };
  CHECK(map(executor, 501, number) == map(Serial{}, 501, number));
  const auto text = [](std::size_t i) { return std::pair(std::string(i % 7, 'x'), std::vector<double>(i % 5, 0.1)); };
  CHECK(map(executor, 40, text) == map(Serial{}, 40, text));
  const auto matrix = [](std::size_t i) { return Eigen::MatrixXd::Constant(static_cast<int>(i), 2, 0.5).eval(); };
  CHECK(map(executor, 9, matrix) == map(Serial{}, 9, matrix));
}

TEST_CASE_TEMPLATE("results that cannot travel are worked out in every process", E, EXECUTORS) {
  const auto results = map(E(), 5, [](std::size_t i) { return std::make_unique<std::size_t>(i); });
  for (std::size_t i = 0; i < 5; ++i) CHECK(*results[i] == i);
}

TEST_CASE_TEMPLATE("jobs fill several arrays of different strides", E, EXECUTORS) {
  std::vector<int> threes(10, -1), ones(4, -1);
  const auto job = [&](std::size_t i) {
    for (std::size_t k = 3 * i; k < std::min<std::size_t>(10, 3 * i + 3); ++k) threes[k] = static_cast<int>(k);
    ones[i] = static_cast<int>(100 * i);
  };
  CHECK(fill(E(), 4, job, {}, Results<int>{threes, 3}, Results<int>{ones}));
  CHECK(threes == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(ones == std::vector<int>{0, 100, 200, 300});
}

TEST_CASE_TEMPLATE("an exception in one process reaches all, that of the lowest index", E, EXECUTORS) {
  const E executor;
  const auto fails_from = [](std::size_t first, auto error) {
    return [first, error](std::size_t i) {
      if (i >= first) throw decltype(error)("job " + std::to_string(i));
      return i;
    };
  };
  for (const std::size_t first : {0U, 1U, 7U}) {
    const std::string words = "job " + std::to_string(first);
    CHECK_THROWS_WITH_AS(map(executor, 40, fails_from(first, std::runtime_error(""))), words.c_str(),
                         std::runtime_error);
    CHECK_THROWS_WITH_AS(map(executor, 40, fails_from(first, CoreError(""))), words.c_str(), CoreError);
  }
  CHECK(map(executor, 3, [](std::size_t i) { return i; }).size() == 3);  // and goes on
}

TEST_CASE_TEMPLATE("a stop in one process stops all", E, EXECUTORS) {
  const E executor;
  const std::size_t last = executor.processes() - 1;
  std::stop_source source;
  if (executor.rank() == last) source.request_stop();
  const auto stop = source.get_token();
  CHECK_FALSE(executor.run(100, [](std::size_t) {}, stop));
  CHECK_FALSE(fill(executor, 100, [](std::size_t) {}, stop));
  CHECK_FALSE(fill(executor, 1, [](std::size_t) {}, stop));  // that process has no job at all
  CHECK_THROWS_AS(map(executor, 100, [](std::size_t i) { return i; }, stop), CoreError);
  CHECK(in_any_process(executor, source.stop_requested()));
  CHECK_FALSE(in_any_process(executor, false));
}

TEST_CASE_TEMPLATE("a stop in mid-run in one process stops all", E, EXECUTORS) {
  const E executor;
  std::stop_source source;
  const auto job = [&](std::size_t i) {
    if (i == 11) source.request_stop();
  };
  CHECK_FALSE(fill(executor, 100'000, job, source.get_token()));
  CHECK(in_any_process(executor, source.stop_requested()));
}

TEST_CASE_TEMPLATE("an executor works inside its own jobs, in their process", E, EXECUTORS) {
  const E executor;
  const auto sums = map(executor, 5, [&](std::size_t i) {
    const auto inner = map(executor, 10, [&](std::size_t j) { return i * j; });
    once(executor, [] {});
    return std::accumulate(inner.begin(), inner.end(), std::size_t{0});
  });
  CHECK(sums == std::vector<std::size_t>{0, 45, 90, 135, 180});
}

TEST_CASE_TEMPLATE("what is done once is done in the first process, and its exception reaches all", E, EXECUTORS) {
  const E executor;
  int runs = 0;
  once(executor, [&] { ++runs; });
  CHECK(runs == (executor.rank() == 0 ? 1 : 0));
  CHECK_THROWS_WITH_AS(once(executor, [] { throw CoreError("disk full"); }), "disk full", CoreError);
}

TEST_CASE_TEMPLATE("processes that ask for different work are told so", E, EXECUTORS) {
  const E executor;
  const std::size_t count = 10 + executor.rank();
  const auto word = "MpiExecutor: the processes ask for different numbers of jobs, " + std::to_string(count) +
                    " in process " + std::to_string(executor.rank()) +
                    ": they must run the same program with the same seed and files";
  CHECK_THROWS_WITH_AS(map(executor, count, [](std::size_t i) { return i; }), word.c_str(), CoreError);
}

}  // namespace
}  // namespace surefoot
