// A walk that drifts: each step adds the same displacement in the frame of the body, whatever was ordered.
// Confusable with ground that slopes (when the heading never changes much) and with an input that favours one side.
#pragma once

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect body_drift() {
  return {
      .name = "body_drift",
      .sentence = "each step drifts by {forward} forward, {lateral} to the left and {turn} of turn",
      .place = Place::planar,
      .parameters = parameters_of(
          {{.name = "forward", .measure = {.value = 1}, .low = -0.3, .high = 0.3, .starts = {0.0005}, .strength = true},
           {.name = "lateral", .measure = {.value = 1}, .low = -0.3, .high = 0.3, .starts = {0.0005}, .strength = true},
           {.name = "turn", .measure = {.position = 1}, .low = -1, .high = 1, .starts = {0.001}, .strength = true}}),
      .confusable_with = names_of({"ground_slope", "input_asymmetry", "cross_coupling"}),
      .experiment = "walk on the spot, starting with several headings",
      .planar = +[](const Pose2& displacement, double, Values p) {
        return Pose2{displacement.x + p[0], displacement.y + p[1], displacement.angle + p[2]};
      }};
}

}  // namespace surefoot::effects
