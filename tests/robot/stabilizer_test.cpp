// The stabilisation of the walk by made-up readings: left alone, out of step, tipping over, fallen.
#include "examples/sigmaban/robot/balance/stabilizer.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "examples/sigmaban/robot/balance/stabilized_walk.hpp"
#include "examples/sigmaban/robot/walk_engine/spline_walk.hpp"

using namespace sigmaban;

namespace {

constexpr double period = 0.01;  // [s]
using Walk = StabilizedWalk<SplineWalk, HandedReading>;

/// Of a robot that rocks and nods in step with its walk, its weight on the foot that carries it.
BodyReading usual_reading(double phase) {
  const double turn = 2 * std::numbers::pi * phase;
  BodyReading reading{.gyro = {0.5 * std::sin(turn), 0.3 * std::cos(2 * turn), 0}, .accelerometer = {0, 0, 9.81}};
  reading.pressure_x.fill(StabilizerOptions().pressure_x);
  reading.loads = phase < 0.5 ? std::array{41.0, 0.0} : std::array{0.0, 41.0};
  return reading;
}

/// Walks for `cycles`; change(reading, phase) may change what is felt. Returns how long it took [s].
double walk(Walk& walk, double cycles, const std::function<void(BodyReading&, double)>& change,
            const std::function<void(const JointTargets&, const JointTargets&, double)>& look = {}) {
  SplineWalk plain({}, walk.phase());
  double walked = 0, seconds = 0;
  while (walked < cycles - 1e-9 && seconds < 60) {
    const double phase = walk.phase();
    BodyReading reading = usual_reading(phase);
    change(reading, phase);
    walk.body().newest = reading;
    const auto targets = walk.step({}, period);
    REQUIRE(targets);
    const auto expected = walk_targets({}, {}, phase);
    if (look) look(*targets, *expected, phase);
    walked += std::remainder(walk.phase() - phase, 1.0);
    seconds += period;
  }
  return seconds;
}

void nothing(BodyReading&, double) {}

}  // namespace

TEST_CASE("without readings a stabilised walk is its engine, to the last bit") {
  Walk walk(SplineWalk({}, 0.2), {}, period);
  SplineWalk engine({}, 0.2);
  for (int i = 0; i < 200; ++i) {
    const WalkOrders orders{0.01, 0.005, 0.1, std::min(1.0, i / 60.0)};
    CHECK(walk.step(orders, period)->array() == engine.step(orders, period)->array());
    CHECK(walk.phase() == engine.phase());
  }
  CHECK_FALSE(walk.fallen());
}

TEST_CASE("a walk as usual is left alone, once it is known what is usual") {
  Walk robot(SplineWalk(), {}, period);
  walk(robot, 20, nothing);
  double largest = 0;
  const double seconds = walk(robot, 3, nothing, [&](const JointTargets& is, const JointTargets& should, double) {
    for (std::size_t i = 0; i < 12; ++i) largest = std::max(largest, std::abs(is.array()[i] - should.array()[i]));
  });
  CHECK(largest < 0.01);
  CHECK(seconds == doctest::Approx(3 / 1.7).epsilon(0.01));
}

TEST_CASE("weight on the foot that should swing delays the phase until it has gone, or for 0.4 s at most") {
  Walk robot(SplineWalk(), {}, period);
  walk(robot, 3, nothing);
  const double undisturbed = walk(robot, 1, nothing);
  int wrong = 15;  // for so many readings the weight stays on the right foot
  const double delayed = walk(robot, 1, [&](BodyReading& reading, double phase) {
    if (phase >= 0.05 && phase < 0.5 && wrong > 0) {
      std::swap(reading.loads[0], reading.loads[1]);
      --wrong;
    }
  });
  CHECK(delayed - undisturbed > 0.07);
  CHECK(delayed - undisturbed < 0.15);
  const double for_good = walk(robot, 1, [&](BodyReading& reading, double phase) {
    if (phase < 0.5) std::swap(reading.loads[0], reading.loads[1]);
  });
  CHECK(for_good - undisturbed == doctest::Approx(0.4).epsilon(0.1));
}

TEST_CASE("a trunk that tips forwards turns the carrying ankle's toes down") {
  Stabilizer stabilizer;
  for (int cycle = 0; cycle < 10; ++cycle) {
    for (int i = 0; i < 60; ++i) stabilizer.feel(usual_reading(i / 60.0), period, i / 60.0, true);
  }
  for (int i = 0; i < 8; ++i) {
    BodyReading reading = usual_reading(0.2 + 0.01 * i);
    reading.gyro.y() += 2;
    stabilizer.feel(reading, period, 0.2 + 0.01 * i, true);
  }
  JointTargets targets;
  stabilizer.correct(targets, 0.28);
  CHECK(targets.left.ankle_pitch > 0.05);
  CHECK(std::abs(targets.right.ankle_pitch) < 1e-9);
  stabilizer.feel_nothing();
  targets = {};
  stabilizer.correct(targets, 0.28);
  CHECK(std::abs(targets.left.ankle_pitch) < 1e-9);
}

TEST_CASE("a centre of pressure before the middle of the feet shifts the trunk back, within bounds") {
  Stabilizer stabilizer;
  const auto stand = [&](int cycles, double pressure) {
    for (int i = 0; i < 60 * cycles; ++i) {
      const double phase = (i % 60) / 60.0;
      BodyReading reading = usual_reading(phase);
      reading.pressure_x = {pressure, pressure};
      stabilizer.feel(reading, period, phase, true);
    }
  };
  stand(5, 0.03);
  CHECK(stabilizer.trim() > 0.03);
  JointTargets targets;
  stabilizer.correct(targets, 0.7);
  CHECK(targets.left.ankle_pitch == doctest::Approx(stabilizer.trim()));
  CHECK(targets.left.hip_pitch == doctest::Approx(-stabilizer.trim()));
  const double before = stabilizer.trim();
  stand(5, -0.03);
  CHECK(stabilizer.trim() < before);
  stand(100, 0.06);
  CHECK(stabilizer.trim() == StabilizerOptions().largest_trim_rad);
}

TEST_CASE("a robot that lies has fallen") {
  Walk robot(SplineWalk(), {}, period);
  for (int i = 0; i < 100; ++i) {
    robot.body().newest = BodyReading{.gyro = {0, i < 50 ? 3.0 : 0.0, 0}, .accelerometer = {-9.81, 0, 0}};
    REQUIRE(robot.step({.enabled = 0}, 0));
  }
  CHECK(robot.fallen());
}
