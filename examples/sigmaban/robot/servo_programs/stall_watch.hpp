// When the machine itself stood still: one thread on each processor that does nothing but sleep, and looks how late it
// wakes up. Where a virtual machine or the system takes a processor away, no program can keep its time.
#pragma once

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include "../bus/realtime.hpp"
#include "../bus/transport.hpp"

namespace dynamixel {

class StallWatch {
 public:
  /// A processor that is late by more than `limit` counts as standing still.
  explicit StallWatch(Time limit = std::chrono::milliseconds(2)) : limit_(limit) {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    sched_getaffinity(0, sizeof allowed, &allowed);
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (CPU_ISSET(cpu, &allowed)) threads_.emplace_back([this, cpu] { run(cpu); });
    }
  }

  ~StallWatch() {
    ending_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  StallWatch(const StallWatch&) = delete;
  StallWatch& operator=(const StallWatch&) = delete;

  /// Whether a processor stood still at some time between these two.
  bool any(Time from, Time to) {
    const std::lock_guard lock(mutex_);
    return std::any_of(stalls_.begin(), stalls_.end(), [&](const Stall& s) { return s.from < to && s.to > from; });
  }

  std::size_t count() {
    const std::lock_guard lock(mutex_);
    return stalls_.size();
  }

 private:
  struct Stall {
    Time from{}, to{};
  };

  static Time now() { return std::chrono::steady_clock::now().time_since_epoch(); }

  void run(int cpu) {
    cpu_set_t mine;
    CPU_ZERO(&mine);
    CPU_SET(cpu, &mine);
    pthread_setaffinity_np(pthread_self(), sizeof mine, &mine);
    ask_for_realtime(90);  // above those that are watched
    for (Time due = now(); !ending_; due = std::max(due + std::chrono::milliseconds(1), now())) {
      std::this_thread::sleep_until(std::chrono::steady_clock::time_point(due));
      const Time woke = now();
      if (woke - due <= limit_) continue;
      const std::lock_guard lock(mutex_);
      stalls_.push_back({due, woke});
    }
  }

  Time limit_;
  std::mutex mutex_;
  std::vector<Stall> stalls_;
  std::atomic<bool> ending_{false};
  std::vector<std::thread> threads_;
};

}  // namespace dynamixel
