// A camera that does not see the ball always, nor exactly, and at times takes something else for it.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "../robot/walk/ball_filter.hpp"
#include "surefoot/core/rng.hpp"

namespace sigmaban {

struct SimulatedCamera {
  double seen = 0.7;    // share of walk cycles in which there is a sighting
  double wrong = 0.02;  // share of sightings that are something else, anywhere within `reach`
  double reach = 2;     // [m]
  SightingNoise noise;

  /// With the ball there, seen from the robot.
  std::optional<BallView> look(const BallView& ball, surefoot::Rng& rng) const {
    constexpr double pi = std::numbers::pi;
    if (rng.uniform(0, 1) >= seen) return std::nullopt;
    if (rng.uniform(0, 1) < wrong) {
      const double distance = rng.uniform(0, reach), direction = rng.uniform(-pi, pi), kick = rng.uniform(-pi, pi);
      return BallView{distance * std::cos(direction), distance * std::sin(direction), kick};
    }
    const double place = noise.position(std::hypot(ball.x, ball.y));
    const double x = ball.x + place * rng.normal(), y = ball.y + place * rng.normal();
    return BallView{x, y, surefoot::wrap_angle(ball.angle + noise.direction_rad * rng.normal())};
  }
};

}  // namespace sigmaban
