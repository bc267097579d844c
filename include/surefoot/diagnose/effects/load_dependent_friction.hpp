// Dry friction that grows with the force carried, as in gears: level = factor * |force|.
// M. Duclusaud, G. Passault, V. Padois, O. Ly: "Extended friction models for the physics simulation of servo
// actuators", 2024. Forms: "drive", the force due to the inputs; "load", the force that remains with inputs and speed
// at zero (say, weight); "gears", what the gears pass on, half the difference of the two; "both", a
// share of each. Confusable with plain dry friction when the load hardly changes, and with a weaker drive when it
// always moves.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect load_friction(std::string form, std::string sentence,
                                          std::function<double(const EffectContext&, Values)> dry) {
  return {.name = "load_dependent_friction",
          .sentence = std::move(sentence),
          .place = Place::velocity,
          // below 1: a joint whose friction exceeds the force that causes it would lock itself
          .parameters = parameters_of(
              {{.name = "factor", .measure = {}, .low = 0, .high = 0.9, .starts = {0.003, 0.1}, .strength = true}}),
          .confusable_with = names_of({"coulomb_friction", "stribeck_friction", "input_gain"}),
          .experiment = "the same slow ramp with reversals under two or three different loads",
          .form = std::move(form),
          .dry = std::move(dry)};
}

[[gnu::cold]] inline Effect load_dependent_friction() {
  Effect effect = load_friction(
      "drive", "dry friction of {factor} times the driving force at {at}",
      +[](const EffectContext& m, Values p) { return p[0] * std::abs(m.drive); });
  effect.needs_drive = true;
  return effect;
}

[[gnu::cold]] inline Effect load_dependent_friction_under_load() {
  Effect effect = load_friction(
      "load", "dry friction of {factor} times the load at {at}",
      +[](const EffectContext& m, Values p) { return p[0] * std::abs(m.load); });
  effect.needs_load = true;
  return effect;
}

[[gnu::cold]] inline Effect load_dependent_friction_in_gears() {
  Effect effect = load_friction(
      "gears", "dry friction of {factor} times the force that the gears pass on at {at}",
      +[](const EffectContext& m, Values p) { return p[0] * 0.5 * std::abs(m.drive - m.load); });
  effect.needs_drive = effect.needs_load = true;
  return effect;
}

/// Bearings and meshes on both sides of a gear: of each force its own share.
[[gnu::cold]] inline Effect load_dependent_friction_on_both_sides() {
  Effect effect = load_friction(
      "both", "dry friction of {factor} times the driving force and {load_factor} times the load at {at}",
      +[](const EffectContext& m, Values p) { return p[0] * std::abs(m.drive) + p[1] * std::abs(m.load); });
  effect.needs_drive = effect.needs_load = true;
  EffectParameter of_load = effect.parameters[0];
  of_load.name = "load_factor";
  of_load.starts = {0, 0.05};
  effect.parameters.push_back(std::move(of_load));
  effect.extends = {"drive", "load", "gears"};
  return effect;
}

}  // namespace surefoot::effects
