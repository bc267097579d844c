// Work on several threads that Ctrl-C ends.
#pragma once

#include <concepts>
#include <cstddef>
#include <stop_token>
#include <utility>

#include "../common/interrupt.hpp"
#include "../common/usage_error.hpp"
#include "surefoot/core/executor.hpp"

namespace calibrate_program {

/// Threads whose every run ends when `token` asks for it.
struct StoppableThreads {
  surefoot::Threads threads;
  std::stop_token token = {};

  std::size_t width() const { return threads.width(); }

  template <std::invocable<std::size_t> Job>
  bool run(std::size_t count, Job&& job, std::stop_token /*stop*/ = {}) const {
    return threads.run(count, std::forward<Job>(job), token);
  }
};

static_assert(surefoot::Executor<StoppableThreads>);

/// Calls work(executor). After Ctrl-C throws example::Interrupted.
template <class Work>
void until_interrupted(std::size_t threads, Work&& work) {
  const example::Interrupt interrupt;
  try {
    work(StoppableThreads{surefoot::Threads(threads), interrupt.token()});
  } catch (const surefoot::Error&) {
    if (interrupt.requested()) throw example::Interrupted{};
    throw;
  }
  if (interrupt.requested()) throw example::Interrupted{};
}

}  // namespace calibrate_program
