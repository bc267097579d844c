// The bus over a line without a port, with every fault.
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "tests/examples/robot_bus_line.hpp"

using namespace dynamixel;

namespace {

constexpr std::uint8_t on = 1;

/// What one fault alone does in 1500 cycles of 20 servos.
template <class Protocol>
struct FaultRun {
  explicit FaultRun(const Faults& faults, Chain chain = Chain::stops)
      : line(20, {.chain = chain, .faults = faults}, options(chain)),
        answers(line.cycle(1500)),
        counted(line.total()),
        made(line.answerer.counts()) {
    CHECK(adds_up(counted));
    CHECK(line.wrong == 0);
    CHECK(line.longest < from_seconds(0.010));
    CHECK(line.answerer.collisions() == 0);
  }

  static BusOptions options(Chain chain) {
    BusOptions quick = TestLine<Protocol>::quick();
    quick.chain = chain;
    if (chain == Chain::goes_on) quick.latency_s = 1e-3;  // longer than the servos' patience
    return quick;
  }

  TestLine<Protocol> line;
  std::size_t answers;
  ServoStatistics counted;
  FaultCounts made;
};

}  // namespace

TEST_CASE_TEMPLATE("a bus pings, reads, writes and stores writes for an action", P, Protocol1, Protocol2) {
  TestLine<P> line(3);
  CHECK(line.bus.ping(2));
  CHECK(line.bus.ping(4).outcome == Outcome::lost);
  CHECK(line.bus.statistics(4).lost == 2);  // it was asked again

  std::array<std::uint8_t, 2> model{};
  REQUIRE(line.bus.read(1, 0, model));
  CHECK(model[0] + 256 * model[1] == mx_64<P>().model_number);

  const std::uint16_t led = mx_64<P>().find("led")->address, torque = mx_64<P>().find("torque_enable")->address;
  CHECK(line.bus.write(3, led, Bytes(&on, 1)));
  std::array<std::uint8_t, 1> value{};
  REQUIRE(line.bus.read(3, led, value));
  CHECK(value[0] == 1);

  CHECK(line.bus.reg_write(1, torque, Bytes(&on, 1)));
  REQUIRE(line.bus.read(1, torque, value));
  CHECK(value[0] == 0);
  line.bus.action();
  REQUIRE(line.bus.read(1, torque, value));
  CHECK(value[0] == 1);

  const Reply refused = line.bus.write(1, 0, model);  // the model number is not for writing
  CHECK(refused.outcome == Outcome::refused);
  CHECK(refused.error_bits != 0);
  CHECK(line.bus.statistics(1).refused == 1);
  CHECK(line.wrong == 0);
}

TEST_CASE_TEMPLATE("all servos are read at once, each its own bytes where asked for", P, Protocol1, Protocol2) {
  TestLine<P> line(5);
  CHECK(line.read_all() == 5);
  const std::uint16_t position = mx_64<P>().find("present_position")->address;
  const std::array<BulkItem, 2> items{BulkItem{4, position, 2}, BulkItem{2, 0, 2}};
  std::array<std::uint8_t, 4> out{};
  std::array<Outcome, 2> outcomes{};
  CHECK(line.bus.bulk_read(items, out, outcomes) == 2);
  CHECK(out[0] + 256 * out[1] == 2048 + 130);  // 0.2 rad
  CHECK(out[2] + 256 * out[3] == mx_64<P>().model_number);
  CHECK(line.wrong == 0);
}

TEST_CASE("arguments that no packet can carry are told") {
  TestLine<Protocol2> line(2);
  std::array<std::uint8_t, 4> out{};
  std::array<Outcome, 1> one{};
  const std::array<std::uint8_t, 2> ids{1, 2};
  CHECK_THROWS_AS(line.bus.ping(253), BusError);
  CHECK_THROWS_AS(line.bus.sync_read(132, 2, ids, out, one), BusError);
  CHECK_THROWS_AS(line.bus.sync_write(116, ids, Bytes(out).first(3)), BusError);
  CHECK_THROWS_AS(line.bus.read(1, 0, Buffer(out).first(0)), BusError);
}

TEST_CASE_TEMPLATE("without faults every answer comes", P, Protocol1, Protocol2) {
  const FaultRun<P> run(Faults{});
  CHECK(run.answers == 30'000);
  CHECK(run.counted.answered == 30'000);
  CHECK(run.counted.asked == 30'000);
  CHECK(run.line.bus.line().dropped_bytes == 0);
}

TEST_CASE_TEMPLATE("lost answers are counted one by one and do not cost those of others", P, Protocol1, Protocol2) {
  for (const Chain chain : {Chain::stops, Chain::goes_on}) {
    const FaultRun<P> run({.lost = 0.02}, chain);
    CHECK(run.counted.lost == run.made.lost);
    CHECK(run.made.lost > 400);
    CHECK(run.counted.corrupted == 0);
    CHECK(run.answers > 30'000 - 60);
  }
}

TEST_CASE_TEMPLATE("corrupted answers are counted one by one and never believed", P, Protocol1, Protocol2) {
  const FaultRun<P> run({.corrupted = 0.02, .corrupted_bytes = P::version == 1 ? 1 : 2});
  CHECK(run.made.corrupted > 400);
  CHECK(run.counted.corrupted == run.made.corrupted);
  CHECK(run.counted.lost == 0);
  CHECK(run.answers > 30'000 - 60);
}

TEST_CASE_TEMPLATE("late answers are counted one by one and never taken for newer ones", P, Protocol1, Protocol2) {
  for (const double late_s : {0.002, 0.012, 0.018}) {
    const FaultRun<P> run({.late = 0.01, .late_s = late_s});
    CHECK(run.made.late > 200);
    CHECK(run.counted.late >= run.made.late);  // with those that come while others are waited for
    CHECK(run.answers > 30'000 - 300);
  }
}

TEST_CASE_TEMPLATE("answers that come twice are counted one by one", P, Protocol1, Protocol2) {
  const FaultRun<P> run({.duplicated = 0.02});
  CHECK(run.counted.duplicates == run.made.duplicated);
  CHECK(run.counted.answered == 30'000);
}

TEST_CASE_TEMPLATE("answers under another's id are refused", P, Protocol1, Protocol2) {
  const FaultRun<P> run({.wrong_id = 0.01});
  CHECK(run.made.wrong_id > 200);
  CHECK(run.line.bus.line().strangers >= run.made.wrong_id * 98 / 100);
  CHECK(run.answers > 30'000 - 60);
}

TEST_CASE_TEMPLATE("all faults at once and the same seed give the same bits", P, Protocol1, Protocol2) {
  const Faults faults{.lost = 0.01, .corrupted = 0.01, .late = 0.01, .duplicated = 0.01, .wrong_id = 0};
  const auto run = [&] {
    TestLine<P> line(8, {.faults = faults, .seed = 5});
    line.cycle(200);
    return std::pair(line.data, line.total().answered);
  };
  CHECK(run() == run());
}

TEST_CASE_TEMPLATE("packets are put together from any pieces", P, Protocol1, Protocol2) {
  for (const std::size_t chunk : {1U, 2U, 7U}) {
    TestLine<P> line(6, {.faults = {.lost = 0.02, .corrupted = 0.02, .corrupted_bytes = 1}}, TestLine<P>::quick(),
                     chunk);
    CHECK(line.cycle(200) > 1180);
    CHECK(line.wrong == 0);
    CHECK(line.total().corrupted == line.answerer.counts().corrupted);
  }
}

TEST_CASE_TEMPLATE("an adapter that hands back what is sent does no harm", P, Protocol1, Protocol2) {
  BusOptions options = TestLine<P>::quick();
  options.echo = true;
  TestLine<P> line(4, {}, options, 1024, true);
  CHECK(line.cycle(10) == 40);
  CHECK(line.bus.ping(1));
  CHECK_FALSE(line.bus.ping(9));
  CHECK(line.bus.line().echoes == line.bus.line().instructions);
  CHECK(adds_up(line.total()));
}

TEST_CASE_TEMPLATE("garbage before, between and after answers is got over", P, Protocol1, Protocol2) {
  TestLine<P> line(4);
  surefoot::Rng rng(3);
  std::size_t answers = 0;
  for (int i = 0; i < 300; ++i) {
    std::array<std::uint8_t, 40> garbage;
    for (auto& byte : garbage) byte = static_cast<std::uint8_t>(rng.below(4) == 0 ? 0xFF : rng.below(256));
    line.bus.port().inject(Bytes(garbage).first(1 + rng.below(40)));
    answers += line.read_all();
    line.bus.port().wait(from_seconds(0.01));
  }
  CHECK(answers == 1200);
  CHECK(line.wrong == 0);
}

TEST_CASE("the beginning of a packet that never ends does not swallow the answers behind it") {
  TestLine<Protocol2> line(2);
  constexpr std::array<std::uint8_t, 9> begun{0xFF, 0xFF, 0xFD, 0x00, 0x01, 0xC8, 0x00, 0x55, 0x00};
  line.bus.port().inject(begun);
  CHECK(line.read_all() == 2);
  CHECK(line.bus.line().dropped_bytes == begun.size());
}

TEST_CASE("a servo that is silent for long costs the others nothing") {
  TestLine<Protocol2> line(20);
  line.answerer.set_silent(7, true);
  CHECK(line.cycle(200) == 200 * 19);
  CHECK(line.bus.statistics(7).consecutive_misses == 200);
  CHECK(line.bus.statistics(7).lost == line.answerer.counts(7).silent);
  CHECK(line.total().skipped == line.answerer.counts().withheld);
  CHECK(line.answerer.counts().withheld < 100);  // it is asked last
  line.answerer.set_silent(7, false);
  CHECK(line.cycle(2) == 40);
  CHECK(line.bus.statistics(7).consecutive_misses == 0);
}

TEST_CASE("where time does not suffice for all, nobody goes without an answer for long") {
  TestLine<Protocol2> line(20, {.faults = {.lost = 0.05}, .seed = 4});
  std::uint64_t longest = 0, incomplete = 0;
  for (int i = 0; i < 2000; ++i) {
    incomplete += line.read_all(line.bus.port().now() + from_seconds(0.003)) < 20 ? 1 : 0;
    for (const std::uint8_t id : line.ids) longest = std::max(longest, line.bus.statistics(id).consecutive_misses);
    line.bus.port().wait(from_seconds(0.005));
  }
  CHECK(incomplete > 200);
  CHECK(longest <= 3);
}

TEST_CASE("a deadline is kept even where nobody answers") {
  TestLine<Protocol2> line(20);
  for (const std::uint8_t id : line.ids) line.answerer.set_silent(id, true);
  for (int i = 0; i < 20; ++i) {
    const Time deadline = line.bus.port().now() + from_seconds(0.003);
    CHECK(line.read_all(deadline) == 0);
    CHECK(line.bus.port().now() <= deadline);
  }
  CHECK(adds_up(line.total()));
}

TEST_CASE("statistics keep error bits and the time of the last answer") {
  TestLine<Protocol2> line(2);
  line.answerer.servo(2).temperature_celsius = 95;
  line.read_all();
  CHECK(line.bus.statistics(1).error_bits == 0);
  CHECK(line.bus.statistics(2).error_bits == protocol2::alert_bit);
  CHECK(line.bus.statistics(2).errors == 1);
  CHECK(line.bus.statistics(2).answered == 1);  // an alert is no refusal
  CHECK(line.bus.statistics(1).last_answer == line.bus.port().now());
}
