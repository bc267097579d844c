#include "torque_guard.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <ctime>
#include <new>

namespace dynamixel {

/// In memory of both processes.
struct TorqueGuard::Shared {
  std::atomic<std::uint64_t> beats{0};
  std::atomic<bool> armed{false};
  std::atomic<bool> fired{false};
  std::size_t size = 0;
  std::array<std::uint8_t, 1024> bytes{};
};

namespace {

constexpr Time look_every = std::chrono::milliseconds(10);

/// After these [ms] since the first: the next ones for bytes that are lost, the last two behind the 100 ms for which a
/// servo waits for the rest of a packet that the program could not end.
constexpr std::array<int, 5> send_after_ms{0, 10, 10, 110, 60};

Time now() { return std::chrono::steady_clock::now().time_since_epoch(); }

void sleep_ms(int milliseconds) {
  const timespec time{0, milliseconds * 1'000'000L};
  nanosleep(&time, nullptr);
}

void say(const char* name, const char* what) {
  for (const char* text : {name, ": ", what, "\n"}) static_cast<void>(!::write(STDERR_FILENO, text, std::strlen(text)));
}

/// False where the port takes nothing.
bool send(int port, const std::uint8_t* bytes, std::size_t size) {
  bool any = false;
  for (const int pause : send_after_ms) {
    sleep_ms(pause);
    std::size_t sent = 0;
    for (int tries = 0; sent < size && tries < 20; ++tries) {
      const ssize_t count = ::write(port, bytes + sent, size - sent);
      if (count > 0) sent += static_cast<std::size_t>(count);
      if (count <= 0) sleep_ms(1);
    }
    any = any || sent == size;
  }
  return any;
}

/// No signal but SIGKILL and SIGSTOP reaches the process, nor what is sent to its parent's terminal or group.
void stand_alone() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, nullptr);
  setsid();
  prctl(PR_SET_NAME, "torque_guard", 0UL, 0UL, 0UL);
  sched_param parameters{};
  if (sched_getparam(0, &parameters) == 0 && parameters.sched_priority > 0) {
    parameters.sched_priority = std::min(99, parameters.sched_priority + 10);  // above a loop that spins
    sched_setscheduler(0, SCHED_FIFO, &parameters);
  }
}

/// Keeps the port and the pipe, as 3 and 4, and standard error.
void close_others(int port, int pipe) {
  const int high_port = fcntl(port, F_DUPFD, 10), high_pipe = fcntl(pipe, F_DUPFD, 10);
  dup2(high_port, 3);
  dup2(high_pipe, 4);
  ::close(0);
  ::close(1);
  syscall(SYS_close_range, 5U, ~0U, 0U);
}

}  // namespace

void TorqueGuard::watch(int port, int pipe, Shared& shared, const TorqueGuardOptions& options) {
  stand_alone();
  close_others(port, pipe);
  const Time longest = from_seconds(options.longest_silence_s);
  Time silence{}, last = now();
  std::uint64_t beats = 0;
  for (;;) {
    pollfd parent{4, POLLIN, 0};
    const bool gone = ::poll(&parent, 1, static_cast<int>(look_every.count() / 1'000'000)) > 0;
    const Time time = now();
    const bool armed = shared.armed.load();
    if (!armed || shared.beats.load() != beats) {
      silence = Time::zero();
      beats = shared.beats.load();
    } else {
      silence += std::min(time - last, 2 * look_every);
    }
    last = time;
    if (armed && (gone || silence > longest)) {
      shared.armed = false;
      shared.fired = true;
      const bool sent = send(3, shared.bytes.data(), shared.size);
      say(options.name, gone ? "the program ended with the torque on" : "the program stands still");
      say(options.name, sent ? "switched the torque of all servos off" : "the port is gone, the torque may be on");
    }
    if (gone) _exit(0);
  }
}

TorqueGuard::TorqueGuard(int file, const TorqueGuardOptions& options) {
  void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  std::array<int, 2> ends{-1, -1};
  if (memory == MAP_FAILED || ::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw BusError(std::string("the torque guard cannot be started: ") + std::strerror(errno));
  }
  shared_ = new (memory) Shared;
  child_ = fork();
  if (child_ == 0) {
    ::close(ends[1]);
    watch(file, ends[0], *shared_, options);
  }
  ::close(ends[0]);
  pipe_ = ends[1];
  if (child_ > 0) return;
  ::close(pipe_);
  munmap(memory, sizeof(Shared));
  throw BusError(std::string("the torque guard cannot be started: ") + std::strerror(errno));
}

TorqueGuard::~TorqueGuard() {
  ::close(pipe_);
  while (waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
  munmap(shared_, sizeof(Shared));
}

void TorqueGuard::arm(Bytes torque_off) {
  if (torque_off.empty() || torque_off.size() > shared_->bytes.size()) {
    throw BusError("the torque guard: an instruction of " + std::to_string(torque_off.size()) + " bytes does not fit");
  }
  shared_->armed = false;
  shared_->size = torque_off.size();
  std::copy(torque_off.begin(), torque_off.end(), shared_->bytes.begin());
  shared_->fired = false;
  beat();
  shared_->armed = true;
}

void TorqueGuard::beat() noexcept { ++shared_->beats; }
void TorqueGuard::disarm() noexcept { shared_->armed = false; }
bool TorqueGuard::fired() const noexcept { return shared_->fired; }

}  // namespace dynamixel
