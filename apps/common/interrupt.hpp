// Ctrl-C as a request to stop, so that long work ends in order and keeps what it has.
#pragma once

#include <pthread.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <stop_token>
#include <thread>

namespace example {

/// While it lives, the first Ctrl-C requests a stop and the second one ends the program at once.
/// Build it before any other thread: SIGINT is blocked in this thread and in those that it starts.
class Interrupt {
 public:
  Interrupt() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
    watcher_ = std::thread([this] { watch(); });
  }

  ~Interrupt() {
    ending_ = true;
    pthread_kill(watcher_.native_handle(), SIGINT);
    watcher_.join();
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return stop_.get_token(); }
  bool requested() const { return stop_.stop_requested(); }

 private:
  void watch() {
    int signal = 0;
    while (sigwait(&signals_, &signal) == 0 && !ending_) {
      if (stop_.stop_requested()) std::_Exit(130);
      stop_.request_stop();
    }
  }

  sigset_t signals_{};
  sigset_t before_{};
  std::stop_source stop_;
  std::atomic<bool> ending_{false};
  std::thread watcher_;
};

}  // namespace example
