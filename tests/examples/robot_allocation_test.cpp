// What runs in a control cycle must not allocate: operator new is replaced by one that counts. Not inlined: GCC
// would take free() for a mismatched deallocation.
#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>

#include "examples/sigmaban_robot/dynamixel/protocol1.hpp"
#include "examples/sigmaban_robot/dynamixel/protocol2.hpp"
#include "examples/sigmaban_robot/walk_engine/spline_walk.hpp"

namespace {
std::atomic<long> allocations{0};
}

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  void* memory = std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

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
