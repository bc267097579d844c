// Signals that ask a program to stop, as requests: the first to stop in order, the second at once.
#pragma once

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <thread>

namespace sigmaban {

enum class StopRequest : int { none, in_order, at_once };

struct StopDeadlines {
  double in_order_s = 3.0;  // after the first signal, the program ends by force; what holds torque lets go then [s]
  double at_once_s = 0.5;   // after the second [s]
};

/// While it lives: Ctrl-C, Ctrl-Z, Ctrl-\, a lost terminal, an ended session, timers and limits of the system. A
/// program that has not stopped by its deadline ends with code 130 (an armed TorqueGuard then switches the torque off).
/// A lost reader of what is printed, and files that become too long, are no signals any more but errors of writing.
/// Build it before any other thread: the signals are blocked in this thread and in those that it starts.
class StopSignals {
 public:
  explicit StopSignals(const StopDeadlines& deadlines = {}) : deadlines_(deadlines) {
    sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGUSR1, SIGUSR2, SIGALRM, SIGXCPU}) {
      sigaddset(&signals_, signal);
    }
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
    for (std::size_t i = 0; i < ignored.size(); ++i) handlers_[i] = std::signal(ignored[i], SIG_IGN);
    watcher_ = std::thread([this] { watch(); });
  }

  ~StopSignals() {
    ending_ = true;
    pthread_kill(watcher_.native_handle(), SIGUSR1);
    watcher_.join();
    for (std::size_t i = 0; i < ignored.size(); ++i) std::signal(ignored[i], handlers_[i]);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  StopRequest request() const { return request_; }
  bool requested() const { return request_ != StopRequest::none; }
  /// The torque is off: what is left may take its time.
  void no_more_deadlines() { bounded_ = false; }

 private:
  static constexpr std::array<int, 2> ignored{SIGPIPE, SIGXFSZ};

  void watch() {
    using Clock = std::chrono::steady_clock;
    Clock::time_point deadline = Clock::time_point::max();
    while (!ending_) {
      const timespec look{0, 50'000'000};
      const int signal = sigtimedwait(&signals_, nullptr, &look);
      if (ending_) return;
      if (bounded_ && Clock::now() > deadline) _exit(130);
      if (signal <= 0) continue;
      const bool first = request_ == StopRequest::none;
      request_ = first ? StopRequest::in_order : StopRequest::at_once;
      const double seconds = first ? deadlines_.in_order_s : deadlines_.at_once_s;
      deadline = std::min(
          deadline, Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds)));
    }
  }

  StopDeadlines deadlines_;
  sigset_t signals_{};
  sigset_t before_{};
  std::array<void (*)(int), 2> handlers_{};
  std::atomic<StopRequest> request_{StopRequest::none};
  std::atomic<bool> ending_{false}, bounded_{true};
  std::thread watcher_;
};

}  // namespace sigmaban
