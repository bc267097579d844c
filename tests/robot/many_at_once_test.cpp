// Instructions to many servos at once beyond the usual ones: bulk write and fast sync read; and the reboot of one.
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "tests/examples/robot_bus_line.hpp"

using namespace dynamixel;

TEST_CASE("a bulk write gives each servo its own registers") {
  TestLine<Protocol2> line(3);
  const std::array items{BulkItem{1, 116, 4}, BulkItem{3, 84, 2}, BulkItem{2, 64, 1}};
  line.bus.bulk_write(items, std::vector<std::uint8_t>{0x34, 0x08, 0, 0, 0x20, 0x03, 1});
  std::array<std::uint8_t, 4> goal{};
  REQUIRE(line.bus.read(1, 116, goal));
  CHECK(goal[0] + 256 * goal[1] == 0x0834);
  std::array<std::uint8_t, 2> gain{};
  REQUIRE(line.bus.read(3, 84, gain));
  CHECK(gain[0] + 256 * gain[1] == 0x0320);
  CHECK(line.answerer.servo(2).torque_on());
  CHECK_FALSE(line.answerer.servo(1).torque_on());
  line.bus.bulk_write({}, {});
  CHECK_THROWS_AS(line.bus.bulk_write(items, std::vector<std::uint8_t>{1}), BusError);
}

TEST_CASE("a servo that is told to reboot answers, starts anew and is limp") {
  TestLine<Protocol2> line(2);
  const std::array<std::uint8_t, 1> on{1};
  REQUIRE(line.bus.write(1, 64, on));
  REQUIRE(line.bus.reboot(1));
  CHECK_FALSE(line.answerer.servo(1).torque_on());
  CHECK_FALSE(line.bus.ping(1));
  line.bus.port().wait(from_seconds(0.5));
  CHECK(line.bus.ping(1));
}

namespace {

BusOptions fast_options() {
  BusOptions options = TestLine<Protocol2>::quick();
  options.fast_sync_read = true;
  return options;
}

}  // namespace

TEST_CASE("a fast sync read brings the same in less time") {
  TestLine<Protocol2> usual(20), fast(20, {}, fast_options());
  const auto seconds = [](auto& line) {
    const Time begin = line.bus.port().now();
    REQUIRE(line.read_all() == 20);
    return to_seconds(line.bus.port().now() - begin);
  };
  const double slowly = seconds(usual), quickly = seconds(fast);
  CHECK(fast.data == usual.data);
  CHECK(fast.wrong == 0);
  CHECK(fast.answerer.sent_bytes() < usual.answerer.sent_bytes() - 19 * 6);  // 7 bytes of each servo but the first
  CHECK(quickly < slowly);
}

TEST_CASE("what a fast sync read does not bring is asked as usual, and nothing wrong is believed") {
  TestLine<Protocol2> line(20, {.faults = {.lost = 0.01, .corrupted = 0.01}}, fast_options());
  CHECK(line.cycle(1500) > 1500 * 20 * 0.99);
  CHECK(line.wrong == 0);
  const ServoStatistics total = line.total();
  CHECK(adds_up(total));
  CHECK(total.corrupted <= line.answerer.counts().corrupted);  // one fault does not count against all
  line.answerer.set_silent(7, true);
  line.read_all();
  CHECK(line.read_all() == 19);
}

TEST_CASE("servos whose firmware knows no fast sync read are read all the same") {
  TestLine<Protocol2> line(5, {.knows_fast_reads = false}, fast_options());
  for (int i = 0; i < 3; ++i) CHECK(line.read_all() == 5);
}
