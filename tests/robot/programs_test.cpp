// The programs themselves on servos behind a pseudo-terminal: unplugged, asked to stop, killed and frozen.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "examples/sigmaban/robot/bus/background_port.hpp"
#include "examples/sigmaban/robot/bus/realtime.hpp"
#include "examples/sigmaban/robot/bus/serial_port.hpp"
#include "examples/sigmaban/robot/servos/servo_group.hpp"
#include "examples/sigmaban/robot/virtual_bus/virtual_bus.hpp"
#include "tests/robot/fault_table.hpp"
#include "tests/support/program.hpp"

using namespace dynamixel;

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Looks until it is so or the time is over; machines may be slow, so the time is much longer than what is promised.
template <class Condition>
bool within(double seconds, Condition condition) {
  const Clock::time_point begin = Clock::now();
  while (seconds_since(begin) < seconds) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return condition();
}

/// A program of this build, running.
class Program {
 public:
  explicit Program(std::vector<std::string> words) {
    words.front() = SUREFOOT_BIN_DIR "/" + words.front();
    child_ = fork();
    if (child_ != 0) return;
    const int out = open(output_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(out, STDOUT_FILENO);
    dup2(out, STDERR_FILENO);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(arguments.front(), arguments.data());
    _exit(97);
  }
  ~Program() {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void signal(int number) const { ::kill(child_, number); }
  /// Its exit code, 128 and the signal that killed it, or -1 if it runs on.
  int wait(double seconds) {
    int status = 0;
    if (!within(seconds, [&] { return waitpid(child_, &status, WNOHANG) == child_; })) return -1;
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  std::string output() const {
    std::ostringstream text;
    text << std::ifstream(output_).rdbuf();
    return text.str();
  }

 private:
  approach_program::ScratchFolder folder_;
  std::string output_ = folder_.file("output");
  pid_t child_ = -1;
};

template <class Protocol>
struct Robot {
  static constexpr const ServoModel& model = Protocol::version == 1 ? mx_64_protocol_1 : mx_64_protocol_2;

  static VirtualBus<Protocol> servos() {
    std::vector<VirtualServo> made;
    for (std::uint8_t id = 1; id <= 12; ++id) made.emplace_back(model, id);
    return VirtualBus<Protocol>{Answerer<Protocol>(made)};
  }
  std::size_t count(bool (VirtualServo::*what)() const) {
    return bus.with([&](const auto& answerer) {
      std::size_t servos = 0;
      for (const VirtualServo& each : answerer.servos()) servos += (each.*what)() ? 1U : 0U;
      return servos;
    });
  }
  std::size_t with_torque() { return count(&VirtualServo::torque_on); }
  std::vector<std::string> walk() const {
    return {"surefoot-walk", "run",     "--problem", "ha", "--protocol", std::to_string(Protocol::version),
            "--port",        bus.path()};
  }

  VirtualBus<Protocol> bus = servos();
};

bool walk_is_built() {
  ask_for_realtime(60);  // above the walk: servos have their own computers
  return std::filesystem::exists(SUREFOOT_BIN_DIR "/surefoot-walk");
}

/// Starts a walk, does something to it, and tells after how long the torque of all is off [s]; 100 where it is not.
template <class Protocol, class Action>
double limp_after(Robot<Protocol>& robot, Program& program, Action action) {
  const bool stands = within(20, [&] { return robot.with_torque() == 12; });
  REQUIRE_MESSAGE(stands, program.output());
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const Clock::time_point begin = Clock::now();
  action();
  const bool limp = within(20, [&] { return robot.with_torque() == 0; });
  const double seconds = limp ? seconds_since(begin) : 100;
  if (std::getenv("SUREFOOT_PRINT_FAULTS") != nullptr) std::printf("program | limp after %.3f s\n", seconds);
  return seconds;
}

}  // namespace

TEST_CASE("a walk whose port is pulled out ends with a sentence, and the servos stop by themselves") {
  if (!walk_is_built()) return;
  Robot<Protocol2> robot;
  Program program(robot.walk());
  REQUIRE_MESSAGE(within(20, [&] { return robot.with_torque() == 12; }), program.output());
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  robot.bus.hang_up();
  CHECK(program.wait(10) == 2);
  CHECK(program.output().find("the port is gone; was the adapter unplugged?") != std::string::npos);
  CHECK(within(10, [&] { return robot.count(&VirtualServo::watchdog_tripped) == 12; }));
}

TEST_CASE("a servo_check whose port is pulled out ends with a sentence") {
  if (!std::filesystem::exists(SUREFOOT_BIN_DIR "/servo_check")) return;
  Robot<Protocol2> robot;
  Program program({"servo_check", "--port", robot.bus.path(), "--baud", "3000000"});
  REQUIRE(within(20, [&] { return robot.bus.with([](const auto& a) { return a.instructions(); }) > 20; }));
  robot.bus.hang_up();
  CHECK(program.wait(10) == 2);
  CHECK(program.output().find("the port is gone") != std::string::npos);
}

TEST_CASE("SIGTERM and a lost terminal sit the robot down, two Ctrl-C let go") {
  if (!walk_is_built()) return;
  for (const int signal : {SIGTERM, SIGHUP, SIGINT}) {
    Robot<Protocol2> robot;
    Program program(robot.walk());
    const double limp = limp_after(robot, program, [&] {
      program.signal(signal);
      if (signal != SIGINT) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      program.signal(SIGINT);
    });
    CAPTURE(program.output());
    CHECK(limp < 6);  // 3 s is what is promised, on a machine that is not busy with tests
    CHECK(program.wait(10) == 130);
    if (signal != SIGINT) CHECK(program.output().find("sits down") != std::string::npos);
    CHECK(robot.count(&VirtualServo::watchdog_tripped) == 0);  // cleared at an orderly end
  }
}

TEST_CASE("kill -9 of a walk: its guard switches the torque off, with servos of either protocol") {
  if (!walk_is_built()) return;
  const auto check = [](auto robot) {
    Program program(robot->walk());
    const double limp = limp_after(*robot, program, [&] { program.signal(SIGKILL); });
    CHECK(limp < 5);
    CHECK(program.wait(10) == 128 + SIGKILL);
    CHECK(
        within(5, [&] { return program.output().find("switched the torque of all servos off") != std::string::npos; }));
  };
  check(std::make_unique<Robot<Protocol2>>());
  check(std::make_unique<Robot<Protocol1>>());
}

TEST_CASE("a frozen walk: its guard switches the torque off, and it ends when it thaws") {
  if (!walk_is_built()) return;
  Robot<Protocol2> robot;
  Program program(robot.walk());
  const double limp = limp_after(robot, program, [&] { program.signal(SIGSTOP); });
  CHECK(limp < 5);
  program.signal(SIGCONT);
  CHECK(program.wait(10) == 2);
  CHECK(robot.with_torque() == 0);
}

TEST_CASE("a loop that hangs in a living process: the guard switches the torque off, and the loop is told") {
  Robot<Protocol2> robot;
  using Line = Bus<Protocol2, BackgroundPort<SerialPort>>;
  Line bus(BackgroundPort(SerialPort(robot.bus.path(), 3'000'000)), {.return_delay_s = 0, .latency_s = 0.02});
  TorqueGuard guard(bus.port().port().file(), {.longest_silence_s = 0.2, .name = "guard under test"});
  std::vector<Joint> joints;
  for (std::uint8_t id = 1; id <= 12; ++id) joints.push_back({.name = std::to_string(id), .id = id});
  ServoGroup<Line> group(bus, Robot<Protocol2>::model, joints, {.watchdog_s = 100, .listen_s = 0.1, .guard = &guard});
  group.start();
  CHECK(robot.with_torque() == 12);
  CHECK(within(10, [&] { return robot.with_torque() == 0; }));  // nobody calls update()
  CHECK(guard.fired());
  CHECK(group.torque_on());
  static_cast<void>(group.update());
  CHECK_FALSE(group.torque_on());
  REQUIRE_FALSE(group.events().empty());
  CHECK(group.events().front().kind == ServoEventKind::watchdog);
}

TEST_CASE("the table of faults says the same of killed and frozen programs") {
  int rows = 0;
  for (const auto& row : sigmaban::read_fault_table(SUREFOOT_SOURCE_DIR "/examples/sigmaban/robot/README.md")) {
    if (row.fault.find("kill -9") == std::string::npos) continue;
    ++rows;
    CHECK(row.reaction == "lets go");
    CHECK(row.torque == "off");
  }
  CHECK(rows == 2);
}

TEST_CASE("kill -9 of walk and guard: servos with a bus watchdog stop by themselves") {
  // A guard that is gone, as when the computer loses its power: the bus falls silent.
  Robot<Protocol2> robot;
  robot.bus.with([](auto& answerer) {
    for (std::uint8_t id = 1; id <= 12; ++id) {
      answerer.servo(id).set("torque_enable", 1);
      answerer.servo(id).set("bus_watchdog", 5);
    }
  });
  CHECK(within(10, [&] { return robot.count(&VirtualServo::watchdog_tripped) == 12; }));
}
