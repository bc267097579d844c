// The life of an MPI program: begin, end in order, and end with a clear word when it cannot go on.
#pragma once

#include <mpi.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "surefoot/core/error.hpp"

namespace surefoot {

/// Starts MPI, and ends it when it is destroyed. An exception that passes by, one that may have come in this process
/// alone, ends all processes at once: the others might wait for this one for ever.
/// If another process of the run is lost, mpirun ends this one by the signal SIGTERM: see when_lost. Build it before
/// any other thread: SIGTERM is blocked in this thread and in those that it starts.
class MpiSession {
 public:
  MpiSession(int& argc, char**& argv) : exceptions_(std::uncaught_exceptions()) {
    sigset_t every, before;
    sigfillset(&every);
    pthread_sigmask(SIG_SETMASK, &every, &before);  // no signal is for the threads that MPI starts
    int level = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (level < MPI_THREAD_FUNNELED) {
      MPI_Finalize();
      throw CoreError("MpiSession: this MPI is not for programs with threads: install one that is");
    }
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &processes_);
    find_first();
    watcher_ = std::thread([this] { watch(); });
  }

  ~MpiSession() {
    if (std::uncaught_exceptions() > exceptions_) MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
    ending_ = true;
    pthread_kill(watcher_.native_handle(), SIGTERM);
    watcher_.join();
    MPI_Finalize();
  }

  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  bool first() const { return rank_ == 0; }

  /// What to write to stderr when another process is lost: what happened and how to go on. The first process that is
  /// left asks for it, in another thread.
  void when_lost(std::function<std::string()> words) {
    const std::scoped_lock lock(words_access_);
    words_ = std::move(words);
  }

  /// For main to return: `code`, once all processes have come here with theirs. If any failed (its code is not 0), the
  /// first that did writes its `words` to stderr. If this one failed and the others do not come within two seconds, it
  /// failed alone and ends them.
  int end(int code, const std::string& words) {
    const int own = code != 0 ? rank_ : processes_;
    int first_failed = 0, all_here = 0;
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallreduce(&own, &first_failed, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD, &request);
    if (code == 0) {
      MPI_Wait(&request, MPI_STATUS_IGNORE);
      return code;
    }
    MPI_Test(&request, &all_here, MPI_STATUS_IGNORE);
    for (int i = 0; all_here == 0 && i < 200; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      MPI_Test(&request, &all_here, MPI_STATUS_IGNORE);
    }
    if (all_here == 0 || rank_ == first_failed) std::fputs(words.c_str(), stderr);
    if (all_here == 0) MPI_Abort(MPI_COMM_WORLD, code);
    return code;
  }

 private:
  // The machine and the number of a process.
  struct Place {
    std::array<char, MPI_MAX_PROCESSOR_NAME> machine{};
    long process = 0;
  };

  void find_first() {
    Place own{.machine = {}, .process = getpid()};
    int length = 0;
    MPI_Get_processor_name(own.machine.data(), &length);
    first_ = own;
    MPI_Bcast(&first_, sizeof(first_), MPI_BYTE, 0, MPI_COMM_WORLD);
    beside_first_ = first_.machine == own.machine;
  }

  void watch() {
    int signal = 0;
    sigwait(&signals_, &signal);
    if (ending_) return;
    // Rank 0 speaks, or rank 1 if it is rank 0 that is gone or cannot be seen from here.
    const bool first_lives = beside_first_ && kill(static_cast<pid_t>(first_.process), 0) == 0;
    const std::scoped_lock lock(words_access_);
    if (words_ && (rank_ == 0 || (rank_ == 1 && !first_lives))) std::fprintf(stderr, "%s\n", words_().c_str());
    std::_Exit(128 + SIGTERM);
  }

  int exceptions_;
  int rank_ = 0, processes_ = 1;
  Place first_;                // rank 0's
  bool beside_first_ = false;  // whether this process is on the same machine
  std::mutex words_access_;
  std::function<std::string()> words_;
  sigset_t signals_{};
  std::atomic<bool> ending_{false};
  std::thread watcher_;
};

}  // namespace surefoot
