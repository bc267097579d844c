// A supply that gives way under load: u (1 - sag |u|), and no more than that gives at all, 1 / (4 sag), for whoever
// asks more does not get less. For an input that is a duty or a voltage, sag is what its source loses per unit of it
// (inner resistance times current per unit). Form "current": at a current that is a state, drive (1 - sag |i|), as an
// inner resistance makes it. Confusable with a limit of the input, which also costs most where it is largest, and with
// a lower gain.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

[[gnu::cold]] inline Effect supply_sag() {
  return {
      .name = "supply_sag",
      .sentence = "the supply of {at} sags by a share of {sag}",
      .place = Place::input,
      .parameters = parameters_of(
          {{.name = "sag", .measure = {.value = -1}, .low = 0, .high = 1, .starts = {0.003, 0.1}, .strength = true}}),
      .confusable_with = names_of({"saturation", "input_gain", "quadratic_drag"}),
      .experiment = "long pushes of several strengths, with the supply's voltage recorded",
      .signal = +[](const EffectContext& m, Values p, Values) {
        const double most = p[0] > 0 ? 1 / (2 * p[0]) : std::numeric_limits<double>::infinity();
        const double asked = std::clamp(m.value, -most, most);
        return asked * (1 - p[0] * std::abs(asked));
      }};
}

/// At a current that is a state: its drive loses a share that grows with it, whoever draws it.
[[gnu::cold]] inline Effect supply_sag_current() {
  return {
      .name = "supply_sag",
      .sentence = "the supply sags by a share of {sag} of the current {at}",
      .place = Place::velocity,
      .parameters = parameters_of(
          {{.name = "sag", .measure = {.value = -1}, .low = 0, .high = 1, .starts = {0.003, 0.1}, .strength = true}}),
      .confusable_with = names_of({"saturation", "input_gain", "quadratic_drag"}),
      .experiment = "long pushes of several strengths, with the supply's voltage recorded",
      .form = "current",
      .needs_drive = true,
      .needs_unit = "A",
      .force =
          +[](const EffectContext& m, Values p, Values) { return -m.drive * std::min(1.0, p[0] * std::abs(m.value)); }};
}

}  // namespace surefoot::effects
