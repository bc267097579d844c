// Both ends of a line that the operating system makes: one for us, the other a device file for any program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "../bus/transport.hpp"

namespace dynamixel {

class PseudoTerminal {
 public:
  /// Throws BusError if the system gives none.
  PseudoTerminal();
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// Of the device file, such as /dev/pts/3.
  const std::string& path() const { return path_; }

  /// Waits until there are bytes, a wake() or `deadline`; returns the bytes there are, none at all if there are none.
  std::size_t read(Buffer bytes, Time deadline);
  /// What the other end does not take in time is dropped: a line does not wait.
  void write(Bytes bytes);
  /// As an adapter that is pulled out: whoever has the other end open finds it gone. For good. By the thread that
  /// reads.
  void hang_up();
  /// Ends a read() of another thread.
  void wake();

  /// As the program at the other end has set it; 0 where nobody has.
  std::uint32_t bits_per_s() const;

  /// Of the monotonic clock.
  static Time now() { return std::chrono::steady_clock::now().time_since_epoch(); }

 private:
  int ours_ = -1;
  int theirs_ = -1;  // open all the time, so that programs may come and go
  int waker_ = -1;
  std::string path_;
};

}  // namespace dynamixel
