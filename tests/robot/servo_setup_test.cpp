// New servos are found, set up, walked with and put back; what a line can hold is said before.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "examples/sigmaban/robot/setup/bus_budget.hpp"
#include "examples/sigmaban/robot/setup/change.hpp"
#include "examples/sigmaban/robot/setup/measure.hpp"
#include "examples/sigmaban/robot/setup/scan.hpp"
#include "examples/sigmaban/robot/virtual_bus/virtual_bus.hpp"
#include "tests/support/program.hpp"

using namespace dynamixel;
using approach_program::ScratchFolder;

namespace {

constexpr std::array three_models{"MX-64(2.0)", "XL430-W250", "XM430-W350"};

/// As from the factory, but that each has its own id.
std::vector<VirtualServo> new_servos(std::uint8_t count) {
  std::vector<VirtualServo> servos;
  for (std::uint8_t id = 1; id <= count; ++id) {
    servos.emplace_back(*find_model(three_models[id % three_models.size()]), id);
    servos.back().set("return_delay_time", 250);
  }
  return servos;
}

template <class Protocol>
struct NewServos {
  VirtualBus<Protocol> bus;

  explicit NewServos(std::vector<VirtualServo> servos)
      : bus(Answerer<Protocol>(std::move(servos), {.own_speeds = true})) {}

  /// The EEPROM of all, one after the other.
  std::vector<std::uint8_t> memory() {
    return bus.with([](const auto& answerer) {
      std::vector<std::uint8_t> bytes;
      for (const VirtualServo& servo : answerer.servos()) {
        std::array<std::uint8_t, 64> head{};
        static_cast<void>(servo.read(0, head));
        bytes.insert(bytes.end(), head.begin(), head.begin() + servo.model().first_ram_address);
      }
      return bytes;
    });
  }
};

std::vector<std::uint8_t> ids_to(std::uint8_t last) {
  std::vector<std::uint8_t> ids;
  for (std::uint8_t id = 1; id <= last; ++id) ids.push_back(id);
  return ids;
}

const ScanOptions quick_scan{.broadcast_s = 0.3};

}  // namespace

TEST_CASE("new servos of three models are found, set up and walked with, and then what they were") {
  NewServos<Protocol2> servos(new_servos(12));
  const std::string port = servos.bus.path();
  const ScratchFolder folder;
  const auto before = servos.memory();
  CHECK(scan_line(port, 1'000'000, 2, quick_scan).empty());
  const auto found = scan_line(port, 57'600, 2, quick_scan);
  REQUIRE(found.size() == 12);
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i].id == i + 1);
    CHECK(find_model(found[i].model_number)->name == three_models[found[i].id % 3]);
  }
  const auto backup = folder.path() / "backup.json";
  const SettingsChange change{
      .new_id = {}, .new_bits_per_s = 3'000'000, .return_delay_s = 0, .settings = {{"temperature_limit", 65.0}}};
  change_settings<Protocol2>({port, 57'600, 2}, ids_to(12), change, backup);
  CHECK(servos.memory() != before);
  CHECK(scan_line(port, 57'600, 2, quick_scan).empty());
  CHECK(scan_line(port, 3'000'000, 2, quick_scan).size() == 12);
  if (std::filesystem::exists(SUREFOOT_BIN_DIR "/surefoot-walk")) {
    // In real time: a machine that is busy with other work may leave servos unheard for too long, which is no fault of
    // theirs.
    const auto walked = approach_program::run_command(
        SUREFOOT_BIN_DIR "/surefoot-walk run --problem ha --ball 0.7 0 0 --seconds 0.5 --baud 3000000 --port " + port);
    const bool busy = walked.output.find("was silent for too long") != std::string::npos ||
                      walked.output.find("the program stands still") != std::string::npos;
    const bool well = walked.code == 0 && walked.output.find("The robot stopped after its time") != std::string::npos;
    CHECK_MESSAGE((well || busy), walked.output);
  }
  restore_settings<Protocol2>(port, read_backup(backup));
  CHECK(servos.memory() == before);
  CHECK(scan_line(port, 57'600, 2, quick_scan).size() == 12);
}

TEST_CASE("a restore finds servos that a setup left half way") {
  NewServos<Protocol2> servos(new_servos(3));
  const ScratchFolder folder;
  const auto before = servos.memory();
  const auto file = folder.path() / "backup.json";
  change_settings<Protocol2>({servos.bus.path(), 57'600, 2}, ids_to(3), {.new_bits_per_s = 1'000'000}, file);
  servos.bus.with([](auto& answerer) { answerer.servo(2).set("baud_rate", 1); });  // that one was not reached
  restore_settings<Protocol2>(servos.bus.path(), read_backup(file));
  CHECK(servos.memory() == before);
}

TEST_CASE("a single servo gets another id and its zero, and both back; Protocol 1.0 too") {
  NewServos<Protocol2> one({VirtualServo(*find_model("XM430-W350"), 1, 0.3)});
  const ScratchFolder folder;
  const auto before = one.memory();
  SettingsChange change{.new_id = std::uint8_t{7}, .zero_here = true};
  const ServoLine line{one.bus.path(), 57'600, 2};
  change_settings<Protocol2>(line, {1}, change, folder.path() / "a.json");
  const auto offset = one.bus.with([](auto& answerer) {
    std::array<std::uint8_t, 4> bytes{};
    static_cast<void>(answerer.servo(7).read(20, bytes));
    return static_cast<std::int16_t>(bytes[0] + 256 * bytes[1]);
  });
  CHECK(offset == doctest::Approx(-0.3 / position_rad).epsilon(0.01));
  restore_settings<Protocol2>(line.port, read_backup(folder.path() / "a.json"));
  CHECK(one.memory() == before);

  NewServos<Protocol1> ax({VirtualServo(*find_model("AX-12"), 1), VirtualServo(*find_model("AX-12"), 2)});
  const auto ax_before = ax.memory();
  CHECK(scan_line(ax.bus.path(), 1'000'000, 1, {.last_id_1 = 3}).size() == 2);
  change = {.new_bits_per_s = 500'000, .return_delay_s = 20e-6};
  change_settings<Protocol1>({ax.bus.path(), 1'000'000, 1}, {1, 2}, change, folder.path() / "b.json");
  CHECK(ax.memory() != ax_before);
  restore_settings<Protocol1>(ax.bus.path(), read_backup(folder.path() / "b.json"));
  CHECK(ax.memory() == ax_before);
}

TEST_CASE("a servo that shut itself down takes torque again after a reboot") {
  NewServos<Protocol2> one({VirtualServo(*find_model("XM430-W350"), 1)});
  one.bus.with([](auto& answerer) { answerer.servo(1).shut_down(protocol2::overload_error); });
  auto bus = open_patiently<Protocol2>(one.bus.path(), 57'600);
  const std::uint8_t on = 1;
  CHECK_FALSE(bus.write(1, 64, Bytes(&on, 1)));
  reboot_servo(bus, 1);
  CHECK(bus.write(1, 64, Bytes(&on, 1)));
  CHECK_THROWS_WITH_AS(reboot_servo(bus, 9), doctest::Contains("servo 9 does not answer"), BusError);
}

TEST_CASE("nothing is changed where anything asked for cannot be") {
  NewServos<Protocol2> servos(new_servos(2));
  const ScratchFolder folder;
  const auto before = servos.memory();
  const ServoLine line{servos.bus.path(), 57'600, 2};
  const auto refused = [&](const SettingsChange& change, const char* why) {
    const auto file = folder.path() / "never.json";
    CHECK_THROWS_WITH_AS(change_settings<Protocol2>(line, ids_to(2), change, file), doctest::Contains(why), BusError);
    CHECK(servos.memory() == before);
    CHECK_FALSE(std::filesystem::exists(file));
  };
  refused({.return_delay_s = 1.0}, "cannot have 1.000000 as its return_delay_time");
  refused({.new_bits_per_s = 123'456}, "cannot do 123456 bit/s");
  refused({.settings = {{"courage", 1.0}}}, "has no register courage");
  refused({.settings = {{"present_position", 1.0}}}, "cannot have");
  refused({.new_id = std::uint8_t{2}}, "is there already");
  std::ofstream(folder.path() / "no.json") << "{}";
  CHECK_THROWS_WITH_AS(read_backup(folder.path() / "no.json"), doctest::Contains("is no backup"), example::UsageError);
}

TEST_CASE("a budget adds bytes, delays and latency, and says what would help") {
  BusBudget budget{.protocol = 2, .servos = 20, .bits_per_s = 1'000'000, .return_delay_s = 250e-6, .latency_s = 1e-3};
  // 14 + 20 (1 + 4) out, 14 + 20 asked, 20 (11 + 4) back
  CHECK(budget.bytes() == 14 + 100 + 34 + 300);
  constexpr double marks = 20 * 0.5 * 10;  // [bits]
  CHECK(budget.cycle_s() == doctest::Approx(448e-5 + 1e-6 * marks + 20 * 250e-6 + 1e-3));
  const auto help = advice(budget, 4'000'000);
  REQUIRE(help.size() == 4);  // delays, speed, both, a second port
  CHECK(help[0].rate_hz == doctest::Approx(1 / (448e-5 + 1e-6 * marks + 1e-3)));
  CHECK(help[2].rate_hz == doctest::Approx(1 / (112e-5 + 0.25e-6 * marks + 1e-3)));
  CHECK(help[2].what == "all of that");
  budget.timer_s = 4e-3;  // 9.6 ms are three ticks
  CHECK(budget.cycle_s() == doctest::Approx(12e-3));
  budget.protocol = 1;
  CHECK(budget.bytes() == 8 + 100 + 7 + 60 + 200);
}

TEST_CASE("the rate of a line is predicted from single answers") {
  NewServos<Protocol2> servos(new_servos(6));
  const LineMeasurement m = measure_line<Protocol2>({servos.bus.path(), 57'600, 2}, ids_to(6), 15);
  CHECK(m.share_lost < 0.1);
  CHECK(m.budget.return_delay_s == doctest::Approx(500e-6));
  CHECK(m.fastest == 4'500'000);
  CHECK(m.budget.cycle_s() == doctest::Approx(m.cycle_s).epsilon(0.15));
}
