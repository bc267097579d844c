// Executors: who does independent jobs 0..count-1, this thread, several, or several processes
// (mpi/mpi_executor.hpp). Results never depend on it.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <span>
#include <stop_token>
#include <type_traits>
#include <utility>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/core/portable.hpp"

namespace surefoot {

/// An executor runs job(i) once for every i in [0, count), in any order, and returns when all have ended. What jobs
/// wrote is there then. After `stop` is requested no further job starts; `run` then returns false (some jobs may not
/// have run). An exception of a job stops the others likewise and is rethrown (that of the lowest index among those
/// thrown).
template <class E>
concept Executor = requires(const E& executor, std::size_t count, void (*job)(std::size_t), std::stop_token stop) {
  { executor.run(count, job, stop) } -> std::same_as<bool>;
  { executor.width() } -> std::convertible_to<std::size_t>;  // how many jobs run at once
};

/// Everything on the calling thread, in order.
struct Serial {
  std::size_t width() const { return 1; }

  template <std::invocable<std::size_t> Job>
  bool run(std::size_t count, Job&& job, std::stop_token stop = {}) const {
    for (std::size_t i = 0; i < count; ++i) {
      if (stop.stop_requested()) return false;
      job(i);
    }
    return true;
  }
};

/// Several threads of this process, started for each run (some ten microseconds each: make jobs larger than that).
class Threads {
 public:
  /// `count` threads; 0 means as many as the machine has.
  explicit Threads(std::size_t count = 0);

  std::size_t width() const { return width_; }

  template <std::invocable<std::size_t> Job>
  bool run(std::size_t count, Job&& job, std::stop_token stop = {}) const {
    const auto each = [&job](std::size_t i) { job(i); };
    return run_each(
        count, [](const void* any, std::size_t i) { (*static_cast<decltype(&each)>(any))(i); }, &each, stop);
  }

 private:
  // One copy for all kinds of jobs: call(job, i) does job i.
  bool run_each(std::size_t count, void (*call)(const void* job, std::size_t i), const void* job,
                const std::stop_token& stop) const;

  std::size_t width_;
};

/// An executor over several processes that all run the same program and call it alike. Its `run` is that of any
/// executor: every process does every job, so that what they write is there. `run_apart` does each job in one process
/// only, job i in number i % processes(), so that jobs that grow or shrink with i are spread evenly; then
/// pack(i, ByteWriter&) there and unpack(i, ByteReader&) in the others carry what job i wrote. What run_apart returns
/// or throws is the same in all processes.
template <class E>
concept Distributed = Executor<E> &&
    requires(const E& executor, std::size_t count, void (*job)(std::size_t), std::stop_token stop,
             void (*pack)(std::size_t, ByteWriter&), void (*unpack)(std::size_t, ByteReader&)) {
  { executor.processes() } -> std::convertible_to<std::size_t>;
  { executor.run_apart(count, job, stop, pack, unpack) } -> std::same_as<bool>;
};

/// What the jobs of a run write: job i writes items [i * per_job, (i + 1) * per_job), as far as there are any.
template <class T>
struct Results {
  std::span<T> items;
  std::size_t per_job = 1;

  std::span<T> of(std::size_t job) const {
    const std::size_t first = std::min(items.size(), job * per_job);
    return items.subspan(first, std::min(per_job, items.size() - first));
  }
};

namespace detail {

template <class T>
void put_items(ByteWriter& out, std::span<T> items) {
  for (const T& item : items) put(out, item);
}

template <class T>
void take_items(ByteReader& in, std::span<T> items) {
  for (T& item : items) take(in, item);
}

}  // namespace detail

/// Runs jobs that write nothing but `results`, which every process has in full afterwards; where a result is not
/// Portable, every process does all the work. Returns false after a stop as `run` does: the results are then
/// incomplete.
template <Executor E, std::invocable<std::size_t> Job, class... T>
bool fill(const E& executor, std::size_t count, Job&& job, std::stop_token stop,
          [[maybe_unused]] Results<T>... results) {
  if constexpr (Distributed<E> && (Portable<T> && ...)) {
    const auto pack = [&]([[maybe_unused]] std::size_t i, ByteWriter& out) {
      (detail::put_items(out, results.of(i)), ...);
    };
    const auto unpack = [&]([[maybe_unused]] std::size_t i, ByteReader& in) {
      (detail::take_items(in, results.of(i)), ...);
    };
    return executor.run_apart(count, std::forward<Job>(job), std::move(stop), pack, unpack);
  } else {
    return executor.run(count, std::forward<Job>(job), std::move(stop));
  }
}

/// The results of job(0), ..., job(count-1), in index order. Throws CoreError if `stop` came before all were done.
template <Executor E, std::invocable<std::size_t> Job>
auto map(const E& executor, std::size_t count, Job&& job, std::stop_token stop = {}) {
  using Result = std::decay_t<std::invoke_result_t<Job&, std::size_t>>;
  static_assert(!std::same_as<Result, bool>, "std::vector<bool> is not safe to fill from several threads");
  std::vector<Result> results(count);
  const auto keep = [&](std::size_t i) { results[i] = job(i); };
  if (!fill(executor, count, keep, stop, Results<Result>{results})) {
    throw CoreError("stopped before all jobs were done");
  }
  return results;
}

/// Calls job() in one process only, the one that writes files and tells the user. An exception reaches all.
template <Executor E, std::invocable Job>
void once(const E& executor, Job&& job) {
  fill(executor, 1, [&](std::size_t) { job(); }, {});
}

/// Whether `flag` is set in any process: what clocks and Ctrl-C say differs between them, what follows must not.
template <Executor E>
bool in_any_process(const E& executor, bool flag) {
  if constexpr (Distributed<E>) {
    for (const int other : map(executor, executor.processes(), [flag](std::size_t) { return flag ? 1 : 0; })) {
      flag = flag || other != 0;
    }
  }
  return flag;
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/core/executor.ipp"
#endif
