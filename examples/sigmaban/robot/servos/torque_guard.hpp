// A process that switches the torque off where its parent cannot: killed, crashed, stopped, or stuck.
#pragma once

#include <sys/types.h>

#include <cstdint>

#include "../bus/transport.hpp"

namespace dynamixel {

struct TorqueGuardOptions {
  double longest_silence_s = 0.25;    // between beats, while armed [s]
  const char* name = "torque guard";  // before what it says on standard error
};

/// Forks. The child has the port's descriptor and a pipe, lets nothing else of the parent live on, takes no signals,
/// and is in a session of its own, so that what ends or stops its parent does not reach it (kill -9 of the whole cgroup
/// does, and so does the end of the computer). It needs no answers and knows no protocol: it sends the bytes it was
/// given. Time in which the machine itself stood still counts as one look.
class TorqueGuard {
 public:
  /// `file`: the open port. Throws BusError if there can be no such process.
  explicit TorqueGuard(int file, const TorqueGuardOptions& options = {});
  /// Ends the child, which switches the torque off first if it is armed.
  ~TorqueGuard();
  TorqueGuard(const TorqueGuard&) = delete;
  TorqueGuard& operator=(const TorqueGuard&) = delete;

  /// From now on, bytes go to the port when no beat comes. At most 1024.
  void arm(Bytes torque_off);
  void beat() noexcept;
  void disarm() noexcept;
  /// Has it sent them?
  bool fired() const noexcept;

 private:
  struct Shared;
  [[noreturn]] static void watch(int port, int pipe, Shared& shared, const TorqueGuardOptions& options);

  Shared* shared_ = nullptr;
  int pipe_ = -1;
  pid_t child_ = -1;
};

}  // namespace dynamixel
