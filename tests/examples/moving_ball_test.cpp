#include "examples/sigmaban/approach/moving_ball.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/solve/rfpi.hpp"

using sigmaban::MovingBall;

namespace {

MovingBall ball_without_noise() {
  MovingBall problem;
  problem.noise = 0;
  problem.robot.noise.half_width.setZero();
  return problem;
}

/// A robot at rest whose walk does not drift.
MovingBall standing_robot() {
  MovingBall problem = ball_without_noise();
  problem.robot.walk = surefoot::FullLinearCorrection();
  return problem;
}

MovingBall::State ball_state(double d, double b, double ball_x, double ball_y) {
  MovingBall::State s;
  s << d, b, 0, 0, 0, 0, ball_x, ball_y;
  return s;
}

}  // namespace

TEST_CASE("with a ball at rest the problem is the plain approach") {
  const MovingBall moving = ball_without_noise();
  for (std::uint64_t i = 0; i < 100; ++i) {
    surefoot::Rng rng(1, i);
    MovingBall::State start = MovingBall::State::Zero();
    start.head<6>() = moving.robot.state_box().sample(rng);
    const auto action = moving.action_box().sample(rng);
    const auto with = moving.step(start, action, rng);
    const auto without = moving.robot.step(start.head<6>(), action, rng);
    CHECK(with.next.head<6>().isApprox(without.next, 1e-12));
    CHECK(with.next.tail<2>().isZero());
    CHECK(with.reward == without.reward);
    CHECK(with.terminal == without.terminal);
  }
}

TEST_CASE("friction stops the ball where a uniformly braked ball stops") {
  const MovingBall problem = standing_robot();
  surefoot::Rng rng(1);
  MovingBall::State s = ball_state(0.5, 0, 0.045, 0);  // stops in the middle of the fifth cycle
  for (int cycle = 0; cycle < 5; ++cycle) s = problem.step(s, {0, 0, 0}, rng).next;
  CHECK(s.tail<2>().isZero());
  CHECK(s[0] == doctest::Approx(0.5 + 0.045 * 0.045 / (2 * problem.friction)));
  const surefoot::Vec<MovingBall::feature_dim> features = problem.features(ball_state(0.5, 0, 0.045, 0));
  CHECK(features[MovingBall::feature_dim - 2] == doctest::Approx(s[0]));
}

TEST_CASE("the velocity of the ball turns with the robot") {
  const MovingBall problem = standing_robot();
  surefoot::Rng rng(1);
  MovingBall::State s = ball_state(0.5, 0, 0.05, 0);
  s[5] = 0.1;
  const auto next = problem.step(s, {0, 0, 0}, rng).next;
  CHECK(next[6] == doctest::Approx(0.04 * std::cos(0.2)));
  CHECK(next[7] == doctest::Approx(-0.04 * std::sin(0.2)));
}

TEST_CASE("the noise never makes the ball faster than any ball at the start, nor moves one at rest") {
  const MovingBall problem;
  surefoot::Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const auto next = problem.step(ball_state(0.5, 0, 0.08, 0), {0, 0, 0}, rng).next;
    REQUIRE(next.tail<2>().norm() <= 0.08 + 1e-12);
    REQUIRE(problem.step(ball_state(0.5, 0, 0, 0), {0, 0, 0}, rng).next.tail<2>().isZero());
  }
}

TEST_CASE("a short RFPI solves the eight dimensions far better than standing still and than random actions") {
  const MovingBall problem;
  surefoot::RfpiOptions options;
  options.first_states = 1500;
  options.max_iterations = 20;
  const auto result = surefoot::rfpi(problem, options, surefoot::Threads{}, 1);
  const surefoot::RolloutOptions trials{.runs = 500, .horizon = MovingBall::horizon};
  const auto still = [](const MovingBall::State&) -> MovingBall::Action { return MovingBall::Action::Zero(); };
  const surefoot::RandomPolicy<3> random(problem.action_box());
  const auto gain_on = [&](const auto& other) {
    return surefoot::compare(problem, result.policy, other, trials, surefoot::Threads{}, 2);
  };
  CHECK(gain_on(still).low() > 30);
  CHECK(gain_on(random).low() > 10);
}
