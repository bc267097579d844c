// The ball as the robot believes it to be: sightings, dead reckoning, outliers, and what the pilot makes of it.
#include "examples/sigmaban/robot/walk/ball_filter.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "examples/sigmaban/approach/winner2016.hpp"
#include "examples/sigmaban/robot/walk/approach_pilot.hpp"
#include "surefoot/core/rng.hpp"

namespace sigmaban {
namespace {

using surefoot::Vec;

const Vec<3> walk_noise(0.0115, 0.0115, 0.05);

/// What the robot sees of a ball that lies still, cycle by cycle, while it walks a curve.
struct CurvedWalk {
  surefoot::Pose2 move{0.05, 0.01, 0.1};
  BallView ball{1.6, 0.3, 2.0};
  surefoot::Rng rng;

  explicit CurvedWalk(std::uint64_t seed) : rng(seed) {}

  void walk() {
    const Vec<3> really = move.vec() + walk_noise.cwiseProduct(Vec<3>(rng.normal(), rng.normal(), rng.normal()));
    const BallView turned = BallView{0, 0, -really[2]} * ball;
    ball = {turned.x - really[0], turned.y - really[1], surefoot::wrap_angle(turned.angle)};
  }
  BallView sighting(const SightingNoise& noise) {
    const double place = noise.position(std::hypot(ball.x, ball.y));
    return {ball.x + place * rng.normal(), ball.y + place * rng.normal(),
            surefoot::wrap_angle(ball.angle + noise.direction_rad * rng.normal())};
  }
};

double distance(const BallView& a, const BallView& b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST_CASE("the filtered ball is nearer to the truth than its sightings, and its deviation is honest") {
  const SightingNoise noise;
  double sighted = 0, filtered = 0, claimed = 0, turned = 0;
  int count = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    CurvedWalk walk(seed);
    BallFilter filter;
    for (int cycle = 0; cycle < 20; ++cycle) {
      const BallView seen = walk.sighting(noise);
      filter.sighted(seen);
      REQUIRE(filter.ball());
      if (cycle >= 5) {
        sighted += std::pow(distance(seen, walk.ball), 2);
        filtered += std::pow(distance(*filter.ball(), walk.ball), 2);
        turned += std::pow(surefoot::wrap_angle(filter.ball()->angle - walk.ball.angle), 2);
        claimed += std::pow(filter.deviation(), 2);
        ++count;
      }
      walk.walk();
      filter.walked(walk.move, walk_noise);
    }
  }
  CHECK(filtered < 0.75 * sighted);
  CHECK(std::sqrt(turned / count) < 0.75 * noise.direction_rad);
  CHECK(filtered < 1.5 * 2 * claimed);  // two directions, the claim is of the worse one
  CHECK(filtered > 0.4 * claimed);
}

TEST_CASE("without sightings it is dead reckoned, for as long as that is worth something") {
  BallFilter filter;
  CHECK_FALSE(filter.ball());
  filter.walked({0.05, 0, 0.1}, walk_noise);
  CHECK_FALSE(filter.ball());
  filter.sighted({1.2, 0.4, 0.5});
  BallView exact{1.2, 0.4, 0.5};
  double before = filter.deviation();
  for (int cycle = 0; cycle < 5; ++cycle) {
    const surefoot::Pose2 move{0.04, -0.01, 0.05};
    filter.walked(move, walk_noise);
    exact = BallView{0, 0, -move.angle} * exact;
    exact = {exact.x - move.x, exact.y - move.y, exact.angle};
    REQUIRE(filter.ball());
    CHECK(distance(*filter.ball(), exact) < 1e-12);
    CHECK(filter.ball()->angle == doctest::Approx(exact.angle));
    CHECK(filter.deviation() > before);
    before = filter.deviation();
  }
  int cycles = 5;
  for (; filter.ball() && cycles < 100; ++cycles) filter.walked({0.0, 0, 0.05}, walk_noise);
  CHECK(cycles > 6);  // several cycles without a sighting lose nothing
  CHECK(cycles < 40);
  filter.sighted({0.5, 0, 0});  // whatever is seen then is believed
  CHECK(filter.ball()->x == 0.5);
}

TEST_CASE("one sighting of something else changes nothing, several in a row are believed") {
  BallFilter filter;
  for (int i = 0; i < 4; ++i) filter.sighted({0.6, 0.1, 0.2});
  filter.sighted({-0.5, 0.9, 2});
  CHECK(distance(*filter.ball(), {0.6, 0.1, 0.2}) < 1e-9);
  filter.sighted({0.6, 0.1, 0.2});
  filter.sighted({1.5, -0.4, 1});
  filter.sighted({-0.2, -0.9, 1});
  CHECK(distance(*filter.ball(), {0.6, 0.1, 0.2}) < 1e-9);
  for (int i = 0; i < 3; ++i) filter.sighted({-0.5, 0.9, 2});
  CHECK(filter.ball()->x == -0.5);
}

TEST_CASE("the kick direction has no jump where it wraps") {
  BallFilter filter;
  for (const double kick : {3.1, -3.1, 3.12, -3.13}) filter.sighted({0.5, 0, kick});
  CHECK(std::abs(filter.ball()->angle) > 3.05);
}

TEST_CASE("the pilot walks to a ball at two metres by sightings in one of three cycles, then halts") {
  const Approach problem = Approach::ha();
  Winner2016 expert(Winner2016Parameters::tuned());
  int arrived = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    expert.reset();
    ApproachPilot pilot(problem, expert);
    surefoot::Rng rng(seed);
    SimulatedBall<Approach> ball(problem, {1.8, -0.8, 0.4}, rng.stream(1));
    Vec<3> speed = Vec<3>::Zero(), before = Vec<3>::Zero();
    bool kick = false, lost = false;
    for (int cycle = 0; cycle < 150 && !kick && !lost; ++cycle) {
      const auto seen = ball.see(speed, before);
      if (cycle > 0) pilot.walked(speed, before);
      if (cycle % 3 == 0) pilot.sighted(*seen);
      const PilotDecision decision = pilot.decide(speed);
      before = speed;
      speed = decision.speed;
      kick = decision.may_kick;
      lost = decision.lost;
    }
    arrived += kick ? 1 : 0;
  }
  CHECK(arrived >= 19);
}

}  // namespace
}  // namespace sigmaban
