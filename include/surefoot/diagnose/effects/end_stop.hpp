// An end stop: the position cannot pass `level`; what hits it comes back with `restitution` of its speed (Newton's law
// of impact). Forms: "upper" and "lower"; "upper, elastic" and "lower, elastic" yield under the load.
// Confusable with a limit of the input (the machine does not get further) and with a hardening spring.
#pragma once

#include <algorithm>
#include <string>
#include <utility>

#include "surefoot/diagnose/effects/detail/constants.hpp"
#include "surefoot/diagnose/effects/detail/extremes.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

// side +1: upper, -1: lower
template <int Side>
[[gnu::cold]] Effect end_stop_of(std::string form) {
  return {
      .name = "end_stop",
      .sentence = "an end stop at {level} that returns {restitution} of the speed, at {at}",
      .place = Place::velocity,
      .parameters = parameters_of({{.name = "level",
                                    .measure = {.position = 1},
                                    .low = -12,
                                    .high = 12,
                                    .starts = {0.6 * Side, 1.0 * Side, 1.5 * Side}},
                                   {.name = "restitution", .measure = {}, .low = 0, .high = 0.95, .starts = {0.1}}}),
      .confusable_with = names_of({"saturation", "cubic_stiffness", "coulomb_friction"}),
      .experiment = "push slowly against the suspected stop, then hit it at two speeds",
      .form = std::move(form),
      .suggest = Side > 0 ? near_largest : near_smallest,
      .limit = +[](Values p, double& value, double& position, double&) {
        if (Side * (position - p[0]) <= 0) return;
        position = p[0];
        if (Side * value > 0) value *= -p[1];
      }};
}

[[gnu::cold]] inline Effect end_stop_upper() { return end_stop_of<1>("upper"); }

[[gnu::cold]] inline Effect end_stop_lower() { return end_stop_of<-1>("lower"); }

// side +1: upper, -1: lower
inline double elastic_force(const EffectContext& m, Values p, int side) {
  const double into = side * (m.position - p[0]);
  return into > 0 ? -side * p[1] * std::max(0.0, into + p[2] * side * m.value) : 0.0;
}

/// A stop that yields: it pushes back with force = stiffness (way into it + settling * speed), and never pulls.
[[gnu::cold]] inline Effect elastic_end_stop(bool upper) {
  Effect stop = upper ? end_stop_upper() : end_stop_lower();
  stop.form += ", elastic";
  stop.sentence =
      "an end stop at {level} that yields, with a spring of {stiffness} and a damper of {settling} times that, at {at}";
  const std::vector<EffectParameter> own = parameters_of(
      {{.name = "stiffness",
        .measure = {.effort = 1, .position = -1},
        .low = 0,
        .high = 1000,
        .starts = {10},
        .strength = true},
       {.name = "settling", .measure = {.value = -1, .position = 1}, .low = 0, .high = 1, .starts = {0.03}}});
  stop.parameters[1] = own[0];
  stop.parameters.push_back(own[1]);
  stop.limit = {};
  stop.force = upper ? +[](const EffectContext& m, Values p, Values) { return elastic_force(m, p, 1); }
                     : +[](const EffectContext& m, Values p, Values) { return elastic_force(m, p, -1); };
  return stop;
}

}  // namespace surefoot::effects
