// Definitions of surefoot/solve/time_limit.hpp.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/solve/time_limit.hpp"

namespace surefoot::detail {

SUREFOOT_INLINE TimeLimit::TimeLimit(std::stop_token outer, double seconds)
    : forward_(std::move(outer), Request{&source_}) {
  if (!(seconds < 1e9)) return;  // 30 years: as good as no limit, and no overflow of the clock
  timer_ = std::jthread([this, seconds](std::stop_token ended) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any never;
    never.wait_for(lock, ended, std::chrono::duration<double>(std::max(0.0, seconds)), [] { return false; });
    if (!ended.stop_requested()) {
      struck_ = true;
      source_.request_stop();
    }
  });
}

}  // namespace surefoot::detail
