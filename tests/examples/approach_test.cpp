#include "examples/sigmaban/approach/approach.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/previous_command_correction.hpp"

using sigmaban::Approach;
using sigmaban::degree;

namespace {

constexpr double pi = std::numbers::pi;

Approach without_noise() {
  Approach problem = Approach::ha();
  problem.noise.half_width.setZero();
  return problem;
}

Approach::State state(double d, double b, double k, double vx = 0, double vy = 0, double vt = 0) {
  Approach::State s;
  s << d, b, k, vx, vy, vt;
  return s;
}

}  // namespace

TEST_CASE("an action is clamped, added to the speed, and the speed is clamped") {
  const Approach problem = Approach::ha();
  const surefoot::Vec<3> from_rest = problem.speed_after({0, 0, 0}, {1, -1, 1});
  CHECK(from_rest == surefoot::Vec<3>{0.02, -0.01, 0.15});
  const surefoot::Vec<3> at_limit = problem.speed_after({0.03, 0.015, -0.1}, {0.02, 0.01, -0.15});
  CHECK(at_limit == surefoot::Vec<3>{0.04, 0.02, -0.2});
}

TEST_CASE("a walk cycle is two steps through the calibrated correction") {
  surefoot::Rng rng(1);
  const surefoot::Pose2 move = without_noise().walk_cycle({0.04, -0.02, 0.1}, {0, 0, 0}, rng);
  CHECK(move.x == doctest::Approx(0.0093 + 1.30 * 0.08 + 0.17 * 0.04 + 0.001 * 0.2));
  CHECK(move.y == doctest::Approx(-0.0026 - 0.075 * 0.08 - 1.47 * 0.04 + 0.101 * 0.2));
  CHECK(move.angle == doctest::Approx(0.0002 - 0.35 * 0.08 - 0.05 * 0.04 + 0.909 * 0.2));
}

TEST_CASE("the robot turns by the displacement's angle, then moves in the turned frame") {
  const Approach problem = without_noise();
  surefoot::Rng rng(1);
  const auto start = state(0.8, 0.5, 0.1, 0.02, 0, 0.2);
  const auto step = problem.step(start, {0, 0, 0}, rng);
  const surefoot::Pose2 move = problem.walk_cycle({0.02, 0, 0.2}, {0.02, 0, 0.2}, rng);
  const double x = 0.8 * std::cos(0.5 - move.angle) - move.x;
  const double y = 0.8 * std::sin(0.5 - move.angle) - move.y;
  CHECK(step.next[0] == doctest::Approx(std::hypot(x, y)));
  CHECK(step.next[1] == doctest::Approx(std::atan2(y, x)));
  CHECK(step.next[2] == doctest::Approx(0.1 - move.angle));
  CHECK(step.next.tail<3>() == start.tail<3>());
  CHECK(step.reward == -1);
}

TEST_CASE("angles wrap around behind the robot") {
  surefoot::Rng rng(1);
  const auto step = without_noise().step(state(0.8, pi - 0.01, -pi + 0.01, 0, 0, 0.2), {0, 0, 0}, rng);
  CHECK(step.next[1] > 2);
  CHECK(step.next[2] > 2);
  const auto back = without_noise().step(state(0.8, -pi + 0.01, pi - 0.01, 0, 0, -0.2), {0, 0, 0}, rng);
  CHECK(back.next[1] < -2);
  CHECK(back.next[2] < -2);
}

TEST_CASE("rewards: the kick zone before the collision before the lost ball before a plain step") {
  const Approach problem = Approach::ha();
  struct Case {
    double x, y, kick, reward;
    bool terminal;
  };
  for (const Case c : {Case{0.2, 0.0, 0.0, 0, false},            // may kick
                       Case{0.16, -0.05, 9 * degree, 0, false},  //
                       Case{0.2, 0.0, 11 * degree, -1, false},   // wrong direction
                       Case{0.2, 0.07, 0.0, -1, false},          // beside the foot
                       Case{0.31, 0.0, 0.0, -1, false},          // too far ahead
                       Case{0.14, 0.0, 0.0, -3, false},          // under the robot
                       Case{-0.19, -0.24, 0.0, -3, false},       //
                       Case{-0.21, 0.0, 0.0, -1, false},         // behind it
                       Case{0.14, 0.26, 0.0, -1, false},         // beside it
                       Case{0.9, 0.5, 0.0, -100, true}}) {       // lost
    CAPTURE(c.x);
    CAPTURE(c.y);
    const auto step = problem.arrive(c.x, c.y, c.kick, {0, 0, 0});
    CHECK(step.reward == c.reward);
    CHECK(step.terminal == c.terminal);
  }
}

TEST_CASE("runs start inside the ring, in any direction, at rest") {
  const Approach problem = Approach::ha();
  surefoot::Vec<3> low{9, 9, 9}, high{-9, -9, -9};
  for (std::uint64_t i = 0; i < 1000; ++i) {
    surefoot::Rng rng(1, i);
    const auto start = problem.initial_state(rng);
    low = low.cwiseMin(start.head<3>());
    high = high.cwiseMax(start.head<3>());
    REQUIRE(start.tail<3>().isZero());
  }
  // Of 1000 draws the outermost miss the ends by more than 2 % of the width once in 10^9 seeds.
  CHECK(low[0] >= 0.4);
  CHECK(high[0] <= 0.95);
  CHECK(low[0] < 0.411);
  CHECK(high[0] > 0.939);
  for (const int angle : {1, 2}) {
    CHECK(low[angle] < -0.96 * pi);
    CHECK(high[angle] > 0.96 * pi);
  }
}

TEST_CASE("the noise fills its box evenly and nothing else") {
  const Approach problem = Approach::ha();
  surefoot::Rng rng(1);
  surefoot::Vec<3> sum = surefoot::Vec<3>::Zero();
  const surefoot::Vec<3> mean = problem.walk.displacement({0, 0, 0}).vec();
  constexpr int draws = 10'000;
  for (int i = 0; i < draws; ++i) {
    const surefoot::Vec<3> scaled =
        (problem.walk_cycle({0, 0, 0}, {0, 0, 0}, rng).vec() - mean).cwiseQuotient(problem.noise.half_width);
    REQUIRE(scaled.cwiseAbs().maxCoeff() <= 1 + 1e-12);
    sum += scaled.cwiseAbs2();
  }
  // The square of a uniform draw on [-1, 1] has mean 1/3 and deviation 0.298.
  CHECK((sum / draws - surefoot::Vec<3>::Constant(1.0 / 3.0)).cwiseAbs().maxCoeff() < 5 * 0.298 / std::sqrt(draws));
}

TEST_CASE("ANHA is HA with a fifth of the lateral steps and half of the lateral noise") {
  const auto ha = Approach::ha().constants;
  const auto anha = Approach::anha().constants;
  CHECK(anha.max_speed == surefoot::Vec<3>{0.04, 0.004, 0.2});
  CHECK(anha.min_speed == surefoot::Vec<3>{-0.02, -0.004, -0.2});
  CHECK(anha.max_acceleration == surefoot::Vec<3>{0.02, 0.002, 0.15});
  CHECK(Approach::anha().noise.half_width == surefoot::Vec<3>{0.02, 0.01, Approach::ha().noise.half_width[2]});
  CHECK(Approach::anha().walk.matrix() == Approach::ha().walk.matrix());
  CHECK(anha.turn_first == ha.turn_first);
}

TEST_CASE("a calibrated walk and noise take the place of the published ones") {
  using Calibrated = sigmaban::ApproachWith<surefoot::PreviousCommandCorrection, surefoot::MotionNoise>;
  static_assert(surefoot::Problem<Calibrated>);
  Calibrated problem = Calibrated::ha();
  problem.constants.turn_first = false;
  surefoot::Vec<21> coefficients = surefoot::PreviousCommandCorrection().parameters();
  coefficients[12] = 0.5;  // half of the last forward order is carried out as well
  problem.walk = surefoot::PreviousCommandCorrection::from_parameters(coefficients);
  surefoot::Rng rng(1);
  const auto start = state(0.8, 0, 0, 0.04, 0, 0.2);
  const auto after = problem.step(start, {0, 0, 0}, rng).next;
  const surefoot::Pose2 robot{0.08 + 0.5 * 0.08, 0, 0.4};
  const surefoot::Vec<2> ball = robot.inverse().transform({0.8, 0});
  CHECK(after[0] == doctest::Approx(ball.norm()));
  CHECK(after[1] == doctest::Approx(std::atan2(ball[1], ball[0])));

  problem.noise.per_speed = {0.05, 0, 0};
  CHECK(problem.step(start, {0, 0, 0}, rng).next[0] != doctest::Approx(ball.norm()));
  const auto standing = state(0.8, 0, 0, 0, 0, 0);
  CHECK(problem.step(standing, {0, 0, 0}, rng).next[0] == doctest::Approx(0.8));
}
