// A serial port of Linux at any speed its driver can do, without delays of the operating system's making.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "transport.hpp"

namespace dynamixel {

/// Of an open terminal [bit/s]; 0 if it does not tell.
std::uint32_t terminal_speed(int file);

/// Raw bytes, 8N1, no flow control. Also takes a pseudo-terminal. Only one program has a port at a time.
class SerialPort {
 public:
  /// Throws BusError: there is no such device, it is no serial port, no permission, busy, or it cannot do that speed.
  SerialPort(const std::string& path, std::uint32_t bits_per_s);
  ~SerialPort();
  SerialPort(SerialPort&& other) noexcept;
  SerialPort& operator=(SerialPort&& other) noexcept;
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /// Of the monotonic clock.
  Time now() const;
  std::uint32_t bits_per_s() const { return bits_per_s_; }
  /// The descriptor of the open port, for a TorqueGuard.
  int file() const { return file_; }

  /// All of `bytes`. Throws BusError if the port is gone, or does not take them before the deadline.
  void write(Bytes bytes, Time deadline);

  /// What there is, at least a byte; 0 if none comes before the deadline. Throws BusError if the port is gone. Linux
  /// may return later than that from any wait for a terminal: until its own thread that hands bytes on has had its
  /// turn. Where other work could delay that thread, put the port into a BackgroundPort.
  std::size_t read(Buffer bytes, Time deadline);

 private:
  bool wait(short events, Time deadline) const;  // false at the deadline
  bool hung_up() const;

  std::string path_;
  int file_ = -1;
  std::uint32_t bits_per_s_ = 0;
};

}  // namespace dynamixel
