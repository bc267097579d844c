// What runs in a control cycle must not allocate.
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <memory>

#include "examples/sigmaban/robot/dynamixel/protocol1.hpp"
#include "examples/sigmaban/robot/dynamixel/protocol2.hpp"
#include "examples/sigmaban/robot/servos/servo_group.hpp"
#include "examples/sigmaban/robot/walk_engine/spline_walk.hpp"
#include "tests/examples/robot_bus_line.hpp"
#include "tests/support/allocation_count.hpp"

TEST_CASE("a step of the walk allocates nothing") {
  long before = allocations;
  const auto something = std::make_unique<std::array<double, 100>>();
  CHECK(allocations > before);  // the counter works
  sigmaban::SplineWalk walk;
  before = allocations;
  int reached = 0;
  for (int i = 0; i < 1000; ++i) reached += walk.step({0.02, 0.01, 0.1}, 0.01) ? 1 : 0;
  reached += walk.step({1, 0, 0}, 0.01) ? 1 : 0;  // out of reach
  CHECK(allocations == before);
  CHECK(reached == 1000);
}

TEST_CASE("encoding and decoding allocate nothing") {
  using namespace dynamixel;
  constexpr std::array<std::uint8_t, 3> ids{1, 2, 3};
  constexpr std::array<std::uint8_t, 6> goals{0, 8, 0xFF, 0xFF, 0xFD, 0};
  std::array<std::uint8_t, 300> buffer;
  protocol1::Decoder<> first;
  protocol2::Decoder<> second;
  int packets = 0;
  const long before = allocations;
  for (int i = 0; i < 100; ++i) {
    first.decode(protocol1::sync_write(buffer, 30, 2, ids, goals), [&](const Packet&) { ++packets; });
    first.decode(goals, [&](const Packet&) { ++packets; });
    second.decode(protocol2::sync_write(buffer, 116, 2, ids, goals), [&](const Packet&) { ++packets; });
    second.decode(protocol2::sync_read(buffer, 132, 4, ids), [&](const Packet&) { ++packets; });
    first.give_up();
  }
  CHECK(allocations == before);
  CHECK(packets >= 300);
}

TEST_CASE_TEMPLATE("a cycle of a group of servos allocates nothing, whatever happens on the line", Protocol,
                   dynamixel::Protocol1, dynamixel::Protocol2) {
  using namespace dynamixel;
  TestLine<Protocol> line(20, {.faults = {.lost = 0.02, .corrupted = 0.02, .late = 0.01, .duplicated = 0.01}});
  std::vector<Joint> joints;
  for (const std::uint8_t id : line.ids) joints.push_back({.name = std::to_string(id), .id = id});
  ServoGroup<Bus<Protocol, MemoryTransport<Protocol>>> group(line.bus, mx_64<Protocol>(), joints);
  group.start();
  const std::vector<double> goals(joints.size(), 0.1);
  std::size_t answered = 0;
  const long before = allocations;
  for (int i = 0; i < 500; ++i) {
    if (i == 100) line.answerer.set_silent(3, true);
    if (i == 300) line.answerer.set_silent(3, false);
    group.set_goals(goals);
    answered += group.update();
    line.bus.port().wait(from_seconds(0.005));
  }
  CHECK(allocations == before);
  CHECK(answered > 9'000);
}
