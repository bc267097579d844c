// The process that switches the torque off, with a pipe for a port.
#include "examples/sigmaban/robot/servos/torque_guard.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

using namespace dynamixel;

namespace {

constexpr std::array<std::uint8_t, 3> torque_off{7, 8, 9};

struct Pipe {
  Pipe() { REQUIRE(pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC) == 0); }
  ~Pipe() {
    for (const int end : ends) close(end);
  }

  /// All that comes until nothing does for that long.
  std::string read(int quiet_ms) {
    std::string all;
    std::array<char, 64> bytes{};
    pollfd waiting{ends[0], POLLIN, 0};
    while (poll(&waiting, 1, quiet_ms) > 0) {
      const ssize_t count = ::read(ends[0], bytes.data(), bytes.size());
      if (count <= 0) break;
      all.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return all;
  }

  std::array<int, 2> ends{-1, -1};
};

void pass(int milliseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds)); }

}  // namespace

TEST_CASE("a guard without beats sends its bytes several times, once") {
  Pipe port;
  TorqueGuard guard(port.ends[1], {.longest_silence_s = 0.05, .name = "guard under test"});
  guard.arm(torque_off);
  const std::string sent = port.read(1000);
  CHECK(sent == "\7\10\11\7\10\11\7\10\11\7\10\11\7\10\11");
  CHECK(guard.fired());
  CHECK(port.read(200).empty());
}

TEST_CASE("a guard with beats, and one that is not armed, send nothing") {
  Pipe port;
  {
    TorqueGuard guard(port.ends[1], {.longest_silence_s = 5});
    guard.arm(torque_off);
    for (int i = 0; i < 10; ++i) {
      guard.beat();
      pass(10);
    }
    CHECK_FALSE(guard.fired());
    guard.disarm();
  }
  CHECK(port.read(100).empty());
}

TEST_CASE("a guard whose program ends while it is armed sends its bytes at once") {
  Pipe port;
  {
    TorqueGuard guard(port.ends[1], {.longest_silence_s = 100, .name = "guard under test"});
    guard.arm(torque_off);
  }
  CHECK(port.read(50).size() == 15);
}

TEST_CASE("a guard takes no instruction that is empty or does not fit") {
  Pipe port;
  TorqueGuard guard(port.ends[1]);
  CHECK_THROWS_AS(guard.arm({}), BusError);
  const std::array<std::uint8_t, 2000> long_one{};
  CHECK_THROWS_AS(guard.arm(long_one), BusError);
}
