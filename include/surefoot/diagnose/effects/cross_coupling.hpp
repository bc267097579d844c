// A walk whose directions mix: `gain` times one part of a step's displacement is added to another part. The forms say
// which: "forward_to_turn" [rad/m], "forward_to_lateral", "lateral_to_turn", "lateral_to_forward", "turn_to_forward"
// [m/rad], "turn_to_lateral".
// Confusable with a drift of the body when the first part is nearly the same in all steps.
#pragma once

#include <string>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// `gain` times the part `from` is added to the part `to`; names as in the forms.
[[gnu::cold]] inline Effect coupling(double Pose2::*from, double Pose2::*to, const std::string& from_name,
                                     const std::string& to_name, EffectParameter gain) {
  return {.name = "cross_coupling",
          .sentence = from_name + " motion causes " + to_name + " motion, {gain}",
          .place = Place::planar,
          .parameters = {std::move(gain)},
          .confusable_with = names_of({"body_drift", "input_asymmetry", "ground_slope"}),
          .experiment = "walks with " + from_name + " steps alone, both ways and in two sizes",
          .form = from_name + "_to_" + to_name,
          .planar = [from, to](const Pose2& displacement, double, Values p) {
            Pose2 moved = displacement;
            moved.*to += p[0] * displacement.*from;
            return moved;
          }};
}

// Turn per distance [rad/m], distance per turn [m/rad], or sideways per distance.
inline EffectParameter turn_gain() {
  return {.name = "gain",
          .measure = {.value = -1, .position = 1},
          .low = -20,
          .high = 20,
          .starts = {0.02},
          .strength = true};
}
inline EffectParameter distance_gain() {
  return {.name = "gain",
          .measure = {.value = 1, .position = -1},
          .low = -2,
          .high = 2,
          .starts = {0.002},
          .strength = true};
}
inline EffectParameter sideways_gain() {
  return {.name = "gain", .measure = {}, .low = -2, .high = 2, .starts = {0.01}, .strength = true};
}

[[gnu::cold]] inline Effect cross_coupling_forward_to_turn() {
  return coupling(&Pose2::x, &Pose2::angle, "forward", "turn", turn_gain());
}
[[gnu::cold]] inline Effect cross_coupling_forward_to_lateral() {
  return coupling(&Pose2::x, &Pose2::y, "forward", "lateral", sideways_gain());
}
[[gnu::cold]] inline Effect cross_coupling_lateral_to_turn() {
  return coupling(&Pose2::y, &Pose2::angle, "lateral", "turn", turn_gain());
}
[[gnu::cold]] inline Effect cross_coupling_lateral_to_forward() {
  return coupling(&Pose2::y, &Pose2::x, "lateral", "forward", sideways_gain());
}
[[gnu::cold]] inline Effect cross_coupling_turn_to_forward() {
  return coupling(&Pose2::angle, &Pose2::x, "turn", "forward", distance_gain());
}
[[gnu::cold]] inline Effect cross_coupling_turn_to_lateral() {
  return coupling(&Pose2::angle, &Pose2::y, "turn", "lateral", distance_gain());
}

}  // namespace surefoot::effects
