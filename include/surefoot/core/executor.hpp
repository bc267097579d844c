// Who does the work: independent jobs 0..count-1, on this thread or on several. Results never depend on it.
#pragma once

#include <algorithm>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "surefoot/core/error.hpp"

namespace surefoot {

/// An executor runs job(i) once for every i in [0, count), in any order, and returns when all have ended.
/// After `stop` is requested no further job starts; `run` then returns false (some jobs may not have run).
/// An exception of a job stops the others likewise and is rethrown (that of the lowest index among those thrown).
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
  explicit Threads(std::size_t count = 0)
      : width_(count != 0 ? count : std::max<std::size_t>(1, std::thread::hardware_concurrency())) {}

  std::size_t width() const { return width_; }

  template <std::invocable<std::size_t> Job>
  bool run(std::size_t count, Job&& job, std::stop_token stop = {}) const {
    const std::size_t threads = std::min(width_, count);
    if (threads <= 1) return Serial{}.run(count, job, stop);
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    std::exception_ptr error;
    std::size_t error_index = count;
    std::mutex error_mutex;
    auto work = [&] {
      while (!failed.load(std::memory_order_relaxed) && !stop.stop_requested()) {
        const std::size_t i = next.fetch_add(1, std::memory_order_relaxed);
        if (i >= count) return;
        try {
          job(i);
        } catch (...) {
          failed.store(true, std::memory_order_relaxed);
          const std::scoped_lock lock(error_mutex);
          if (i < error_index) {
            error_index = i;
            error = std::current_exception();
          }
        }
      }
    };
    {
      std::vector<std::jthread> helpers;
      helpers.reserve(threads - 1);
      for (std::size_t t = 1; t < threads; ++t) helpers.emplace_back(work);
      work();
    }
    if (error) std::rethrow_exception(error);
    return next.load() >= count;
  }

 private:
  std::size_t width_;
};

/// The results of job(0), ..., job(count-1), in index order. Throws CoreError if `stop` came before all were done.
template <Executor E, std::invocable<std::size_t> Job>
auto map(const E& executor, std::size_t count, Job&& job, std::stop_token stop = {}) {
  using Result = std::decay_t<std::invoke_result_t<Job&, std::size_t>>;
  static_assert(!std::same_as<Result, bool>, "std::vector<bool> is not safe to fill from several threads");
  std::vector<Result> results(count);
  if (!executor.run(count, [&](std::size_t i) { results[i] = job(i); }, stop)) {
    throw CoreError("stopped before all jobs were done");
  }
  return results;
}

}  // namespace surefoot
