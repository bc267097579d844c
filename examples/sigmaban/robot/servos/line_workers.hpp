// Threads that do the same for each serial line at the same time, over and over.
#pragma once

#include <barrier>
#include <cstddef>
#include <thread>
#include <vector>

namespace dynamixel {

/// One thread for each line but the first, which the caller's own thread takes. They inherit its real-time priority.
/// Running allocates nothing.
class LineWorkers {
 public:
  explicit LineWorkers(std::size_t lines)
      : begin_(static_cast<std::ptrdiff_t>(lines)), end_(static_cast<std::ptrdiff_t>(lines)) {
    for (std::size_t i = 1; i < lines; ++i) {
      threads_.emplace_back([this, i] { work(i); });
    }
  }
  ~LineWorkers() {
    task_ = nullptr;
    begin_.arrive_and_wait();
    for (std::thread& thread : threads_) thread.join();
  }
  LineWorkers(const LineWorkers&) = delete;
  LineWorkers& operator=(const LineWorkers&) = delete;

  /// action(line) for each line, and waits for all. It must not throw.
  template <class Action>
  void run(const Action& action) {
    context_ = &action;
    task_ = [](const void* context, std::size_t line) { (*static_cast<const Action*>(context))(line); };
    begin_.arrive_and_wait();
    task_(context_, 0);
    end_.arrive_and_wait();
  }

 private:
  void work(std::size_t line) {
    while (true) {
      begin_.arrive_and_wait();
      if (task_ == nullptr) return;
      task_(context_, line);
      end_.arrive_and_wait();
    }
  }

  std::barrier<> begin_, end_;
  const void* context_ = nullptr;
  void (*task_)(const void*, std::size_t) = nullptr;
  std::vector<std::thread> threads_;
};

}  // namespace dynamixel
