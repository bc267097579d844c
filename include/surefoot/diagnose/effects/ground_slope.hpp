// Ground that slopes, or a carpet with a grain: each step adds the same displacement in the frame of the world.
// Form "distance": the displacement is proportional to the length of the step.
// Confusable with a drift of the body, unless the heading changes by half a turn or more.
#pragma once

#include <cmath>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// The displacement, in the frame of the body, with (x, y) of the world added to it.
inline Pose2 moved_in_world(const Pose2& displacement, double heading, double x, double y) {
  const double c = std::cos(heading), s = std::sin(heading);
  return {displacement.x + c * x + s * y, displacement.y - s * x + c * y, displacement.angle};
}

[[gnu::cold]] inline Effect ground_slope() {
  const EffectParameter x{
      .name = "x", .measure = {.value = 1}, .low = -0.3, .high = 0.3, .starts = {0.0005}, .strength = true};
  EffectParameter y = x;
  y.name = "y";
  return {.name = "ground_slope",
          .sentence = "the ground carries each step by {x} along x and {y} along y of the world",
          .place = Place::planar,
          .parameters = {x, y},
          .confusable_with = names_of({"body_drift", "input_asymmetry"}),
          .experiment = "the same walk with headings all around the circle",
          .planar = +[](const Pose2& displacement, double heading, Values p) {
            return moved_in_world(displacement, heading, p[0], p[1]);
          }};
}

[[gnu::cold]] inline Effect ground_slope_distance() {
  const EffectParameter x{.name = "x", .measure = {}, .low = -2, .high = 2, .starts = {0.01}, .strength = true};
  EffectParameter y = x;
  y.name = "y";
  return {.name = "ground_slope",
          .sentence = "the ground carries the robot by {x} along x and {y} along y of the world, per distance walked",
          .place = Place::planar,
          .parameters = {x, y},
          .confusable_with = names_of({"body_drift", "input_gain"}),
          .experiment = "walks with short and long steps, with headings all around the circle",
          .form = "distance",
          .planar = +[](const Pose2& displacement, double heading, Values p) {
            const double length = std::hypot(displacement.x, displacement.y);
            return moved_in_world(displacement, heading, p[0] * length, p[1] * length);
          }};
}

}  // namespace surefoot::effects
