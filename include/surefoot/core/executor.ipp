// Definitions of surefoot/core/executor.hpp.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/executor.hpp"

namespace surefoot {

SUREFOOT_INLINE Threads::Threads(std::size_t count)
    : width_(count != 0 ? count : std::max<std::size_t>(1, std::thread::hardware_concurrency())) {}

SUREFOOT_INLINE bool Threads::run_each(std::size_t count, void (*call)(const void* job, std::size_t i), const void* job,
                                       const std::stop_token& stop) const {
  const std::size_t threads = std::min(width_, count);
  if (threads <= 1)
    return Serial{}.run(
        count, [&](std::size_t i) { call(job, i); }, stop);
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
        call(job, i);
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

}  // namespace surefoot
