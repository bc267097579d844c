// The whole way: serial port, pseudo-terminal, servos in real time; and the programs around them.
#include <doctest/doctest.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "examples/sigmaban/robot/bus/bus.hpp"
#include "examples/sigmaban/robot/bus/serial_port.hpp"
#include "examples/sigmaban/robot/servo_programs/servo_ids.hpp"
#include "examples/sigmaban/robot/virtual_bus/virtual_bus.hpp"
#include "tests/support/program.hpp"

using namespace dynamixel;

namespace {

std::string message_of(const std::string& path, std::uint32_t speed = 1'000'000) {
  try {
    const SerialPort port(path, speed);
  } catch (const BusError& error) {
    return error.what();
  }
  return "";
}

VirtualBus<Protocol2> three_servos() {
  std::vector<VirtualServo> servos;
  for (const std::uint8_t id : std::array<std::uint8_t, 3>{1, 2, 3})
    servos.emplace_back(mx_64_protocol_2, id, 0.1 * id);
  return VirtualBus<Protocol2>{Answerer<Protocol2>(servos)};
}

}  // namespace

TEST_CASE("a port that cannot be used says why and what to do") {
  CHECK(message_of("/dev/there_is_none") == "/dev/there_is_none: there is no such device; is the adapter plugged in?");
  CHECK(message_of("/dev/null") == "/dev/null: is no serial port");
  const auto line = three_servos();
  CHECK(message_of(line.path(), 0).find("0 bit/s") != std::string::npos);
  const SerialPort port(line.path(), 3'000'000);
  CHECK(message_of(line.path()).find("busy, another program has it") != std::string::npos);
}

TEST_CASE("a port waits until its deadline, and can be moved") {
  const auto line = three_servos();
  SerialPort first(line.path(), 3'000'000);
  SerialPort port(std::move(first));
  std::array<std::uint8_t, 16> bytes{};
  const Time deadline = port.now() + std::chrono::milliseconds(20);
  CHECK(port.read(bytes, deadline) == 0);
  CHECK(port.now() >= deadline);
  CHECK(port.bits_per_s() == 3'000'000);
}

TEST_CASE("servos behind a pseudo-terminal answer, and what is accepted is what they had") {
  auto line = three_servos();
  // a loaded machine may be late, which is no error: nothing wrong is accepted, and the answers come in the end
  Bus<Protocol2, SerialPort> bus(SerialPort(line.path(), 3'000'000), {.return_delay_s = 0, .latency_s = 0.05});
  CHECK(bus.ping(2));
  const std::array<std::uint8_t, 3> ids{1, 2, 3};
  std::array<std::uint8_t, 3 * 19> out{};
  std::array<Outcome, 3> outcomes{};
  std::size_t answered = 0, wrong = 0;
  for (int i = 0; i < 20; ++i) {
    const auto first = line.with([](const auto& answerer) { return answerer.instructions() + 1; });
    answered += bus.sync_read(128, 19, ids, out, outcomes);
    for (std::size_t j = 0; j < ids.size(); ++j) {
      const Bytes bytes = Bytes(out).subspan(19 * j, 19);
      const bool right = line.with([&](const auto& answerer) { return answerer.gave(ids[j], bytes, first); });
      wrong += outcomes[j] == Outcome::answered && !right ? 1U : 0U;
    }
  }
  CHECK(answered >= 57);
  CHECK(wrong == 0);
}

TEST_CASE("ids on a command line are numbers and ranges") {
  CHECK(example::parse_ids("1-3,7") == std::vector<std::uint8_t>{1, 2, 3, 7});
  for (const char* wrong : {"", "1,", "3-1", "253", "1-2-3", "one", "1,1"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(example::parse_ids(wrong), example::UsageError);
  }
}

TEST_CASE("servo_check tells which of the virtual servos are there") {
  const std::string bin = SUREFOOT_BIN_DIR;
  if (!std::filesystem::exists(bin + "/servo_check")) return;
  const approach_program::ScratchFolder scratch;
  const std::string port = scratch.file("port");
  const std::string serve = bin + "/virtual_servos --servos 3-5 --port-link " + port + " --hot 4 & servos=$!; ";
  const std::string wait = "for i in $(seq 100); do test -e " + port + " && break; sleep 0.05; done; ";
  const std::string check = bin + "/servo_check --port " + port + " --ids 1-6 --baud 3000000; code=$?; ";
  const auto result =
      approach_program::run_command(serve + "{ " + wait + check + "kill -INT $servos; wait; exit $code; }");
  CAPTURE(result.output);
  CHECK(result.code == 0);
  CHECK(result.output.find("3 of 6 ids answered") != std::string::npos);
  CHECK(result.output.find("MX-64(2.0)") != std::string::npos);
  CHECK(result.output.find("alarm") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(port));
}
