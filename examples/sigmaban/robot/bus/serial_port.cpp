// termios2 takes any speed but lives in a header that clashes with <termios.h>, so everything of it is here.
#include "serial_port.hpp"

#include <asm/termbits.h>
#include <fcntl.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

namespace dynamixel {

namespace {

constexpr const char* port_is_gone = "the port is gone; was the adapter unplugged?";

[[noreturn]] void fail(const std::string& path, const std::string& what) { throw BusError(path + ": " + what); }

std::string why_not_opened(int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return "there is no such device; is the adapter plugged in?";
    case EACCES:
    case EPERM:
      return "no permission; add yourself to the group dialout (sudo usermod -aG dialout $USER) and log in again";
    case EBUSY:
      return "busy, another program has it; end that program";
    default:
      return std::string("cannot be opened: ") + std::strerror(error);
  }
}

/// Raw 8N1 at that speed; false if the device refuses.
bool configure(int file, std::uint32_t bits_per_s) {
  termios2 settings{};
  if (ioctl(file, TCGETS2, &settings) != 0) return false;
  settings.c_iflag = 0;
  settings.c_oflag = 0;
  settings.c_lflag = 0;
  settings.c_cflag = BOTHER | (BOTHER << IBSHIFT) | CS8 | CREAD | CLOCAL;
  settings.c_ispeed = bits_per_s;
  settings.c_ospeed = bits_per_s;
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  return ioctl(file, TCSETS2, &settings) == 0;
}

/// Bytes are handed on as they come, not every 16 ms. Pseudo-terminals and some adapters have no such setting.
void ask_for_low_latency(int file) {
  serial_struct settings{};
  if (ioctl(file, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= ASYNC_LOW_LATENCY;
  static_cast<void>(ioctl(file, TIOCSSERIAL, &settings));
}

}  // namespace

std::uint32_t terminal_speed(int file) {
  termios2 settings{};
  return ioctl(file, TCGETS2, &settings) == 0 ? settings.c_ospeed : 0;
}

SerialPort::SerialPort(const std::string& path, std::uint32_t bits_per_s) : path_(path), bits_per_s_(bits_per_s) {
  if (bits_per_s == 0) fail(path, "a speed of 0 bit/s was asked for; give the servos' one, for example 1000000");
  file_ = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (file_ < 0) fail(path, why_not_opened(errno));
  const auto close_and_fail = [&](const std::string& what) {
    ::close(std::exchange(file_, -1));
    fail(path, what);
  };
  if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) close_and_fail(why_not_opened(EBUSY));
  if (terminal_speed(file_) == 0 && errno == ENOTTY) close_and_fail("is no serial port");
  if (!configure(file_, bits_per_s)) {
    close_and_fail("refuses " + std::to_string(bits_per_s) + " bit/s: " + std::strerror(errno));
  }
  const double speed = terminal_speed(file_);
  if (speed < 0.97 * bits_per_s || speed > 1.03 * bits_per_s) {
    close_and_fail("cannot do " + std::to_string(bits_per_s) + " bit/s, only " +
                   std::to_string(static_cast<long>(speed)));
  }
  ask_for_low_latency(file_);
  ioctl(file_, TCFLSH, TCIOFLUSH);
}

SerialPort::~SerialPort() {
  if (file_ >= 0) ::close(file_);
}

SerialPort::SerialPort(SerialPort&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)), bits_per_s_(other.bits_per_s_) {}

SerialPort& SerialPort::operator=(SerialPort&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(file_, other.file_);
  std::swap(bits_per_s_, other.bits_per_s_);
  return *this;
}

Time SerialPort::now() const { return std::chrono::steady_clock::now().time_since_epoch(); }

bool SerialPort::wait(short events, Time deadline) const {
  for (;;) {
    const Time left = std::max(Time::zero(), deadline - now());
    const timespec timeout{static_cast<time_t>(left.count() / 1'000'000'000), left.count() % 1'000'000'000};
    pollfd waiting{file_, events, 0};
    const int ready = ppoll(&waiting, 1, &timeout, nullptr);
    if (ready > 0 && (waiting.revents & events) != 0) return true;
    if (ready > 0) fail(path_, port_is_gone);
    if (ready < 0 && errno != EINTR) fail(path_, std::string("cannot be waited for: ") + std::strerror(errno));
    if (left == Time::zero()) return false;
  }
}

void SerialPort::write(Bytes bytes, Time deadline) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file_, bytes.data(), bytes.size());
    if (count > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    } else if (count == 0 || errno == EAGAIN) {
      if (hung_up()) fail(path_, port_is_gone);
      if (!wait(POLLOUT, deadline)) fail(path_, "takes no bytes; is the speed of the port right?");
    } else if (errno == EIO) {
      fail(path_, port_is_gone);
    } else if (errno != EINTR) {
      fail(path_, std::string("cannot be written to: ") + std::strerror(errno));
    }
  }
}

std::size_t SerialPort::read(Buffer bytes, Time deadline) {
  constexpr int most_empty_reads = 3;  // of a port that says it has bytes; one may be empty where they were flushed
  int empty = 0;
  while (wait(POLLIN, deadline)) {
    const ssize_t count = ::read(file_, bytes.data(), bytes.size());
    if (count > 0) return static_cast<std::size_t>(count);
    if (count == 0 && (hung_up() || ++empty == most_empty_reads)) fail(path_, port_is_gone);
    if (count < 0 && errno == EIO) fail(path_, port_is_gone);
    if (count < 0 && errno != EAGAIN && errno != EINTR) {
      fail(path_, std::string("cannot be read from: ") + std::strerror(errno));
    }
  }
  return 0;
}

bool SerialPort::hung_up() const {
  pollfd asked{file_, 0, 0};
  return ::poll(&asked, 1, 0) > 0 && (asked.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
}

}  // namespace dynamixel
