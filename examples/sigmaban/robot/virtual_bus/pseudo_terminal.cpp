#include "pseudo_terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <utility>

#include "../bus/serial_port.hpp"

namespace dynamixel {

PseudoTerminal::PseudoTerminal() {
  const auto fail = [this](const char* what) {
    const std::string reason = std::strerror(errno);
    for (const int file : {ours_, theirs_, waker_}) {
      if (file >= 0) ::close(file);
    }
    throw BusError(std::string("pseudo-terminal: ") + what + " (" + reason + "); is /dev/pts mounted?");
  };
  ours_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (ours_ < 0) fail("the system gives none");
  std::array<char, 64> name{};
  if (grantpt(ours_) != 0 || unlockpt(ours_) != 0 || ptsname_r(ours_, name.data(), name.size()) != 0) {
    fail("cannot be unlocked");
  }
  path_ = name.data();
  theirs_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (theirs_ < 0) fail("its other end cannot be opened");
  termios settings{};
  if (tcgetattr(theirs_, &settings) != 0) fail("has no settings");
  cfmakeraw(&settings);
  if (tcsetattr(theirs_, TCSANOW, &settings) != 0) fail("cannot be set");
  waker_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (waker_ < 0) fail("cannot be woken");
}

PseudoTerminal::~PseudoTerminal() {
  hang_up();
  ::close(waker_);
}

void PseudoTerminal::hang_up() {
  if (ours_ < 0) return;
  ::close(std::exchange(theirs_, -1));
  ::close(std::exchange(ours_, -1));
}

std::size_t PseudoTerminal::read(Buffer bytes, Time deadline) {
  const Time left = std::max(Time::zero(), deadline - now());
  const timespec timeout{static_cast<time_t>(left.count() / 1'000'000'000), left.count() % 1'000'000'000};
  std::array<pollfd, 2> waiting{pollfd{ours_, POLLIN, 0}, pollfd{waker_, POLLIN, 0}};
  if (ppoll(waiting.data(), waiting.size(), &timeout, nullptr) <= 0) return 0;
  if ((waiting[1].revents & POLLIN) != 0) {
    std::uint64_t ignored = 0;
    static_cast<void>(!::read(waker_, &ignored, sizeof ignored));
  }
  if ((waiting[0].revents & POLLIN) == 0) return 0;
  const ssize_t count = ::read(ours_, bytes.data(), bytes.size());
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

void PseudoTerminal::write(Bytes bytes) { static_cast<void>(!::write(ours_, bytes.data(), bytes.size())); }

std::uint32_t PseudoTerminal::bits_per_s() const { return terminal_speed(theirs_); }

void PseudoTerminal::wake() {
  const std::uint64_t one = 1;
  static_cast<void>(!::write(waker_, &one, sizeof one));
}

}  // namespace dynamixel
