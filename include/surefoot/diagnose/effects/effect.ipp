// Definitions of surefoot/diagnose/effects/effect.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot {

namespace detail {

/// A function of an effect: its name, whether it is set, and the places that call it.
struct EffectFunction {
  const char* name;
  bool set;
  std::initializer_list<Place> places;
};

[[noreturn]] SUREFOOT_INLINE void refuse(const Effect& effect, const std::string& why) {
  throw DiagnoseError("effect '" + effect.name + "': " + why);
}

SUREFOOT_ONCE const char* in_words(Place place) {
  switch (place) {
    case Place::velocity:
      return "velocity";
    case Place::state:
      return "state";
    case Place::input:
      return "input";
    case Place::output:
      return "output";
    case Place::planar:
      return "planar";
    case Place::parameter:
      break;
  }
  return "parameter";
}

SUREFOOT_ONCE void check_functions(const Effect& effect) {
  const EffectFunction functions[] = {
      {"force", bool(effect.force), {Place::velocity, Place::state}},
      {"position_rate", bool(effect.position_rate), {Place::velocity}},
      {"dry", bool(effect.dry), {Place::velocity}},
      {"seen_position", bool(effect.seen_position), {Place::velocity}},
      {"limit", bool(effect.limit), {Place::velocity, Place::state}},
      {"signal", bool(effect.signal), {Place::input}},
      {"delay", bool(effect.delay), {Place::input, Place::output}},
      {"sensor", bool(effect.sensor), {Place::output}},
      {"planar", bool(effect.planar), {Place::planar}},
      {"factor", bool(effect.factor), {Place::parameter}},
  };
  bool any = false;
  std::string called;
  for (const EffectFunction& function : functions) {
    const bool fits = std::find(function.places.begin(), function.places.end(), effect.place) != function.places.end();
    if (function.set && !fits) {
      refuse(effect, std::string("the function '") + function.name + "' is never called at Place::" +
                         in_words(effect.place) + "; leave it out, or choose another place");
    }
    any = any || function.set;
    if (fits) called += std::string(called.empty() ? "" : ", ") + function.name;
  }
  if (!any) {
    refuse(effect, std::string("does nothing: at Place::") + in_words(effect.place) + " set one of " + called);
  }
}

SUREFOOT_ONCE void check_parameter(const Effect& effect, const EffectParameter& parameter) {
  if (parameter.name.empty()) refuse(effect, "a parameter has no name");
  int same = 0;
  for (const EffectParameter& other : effect.parameters) same += other.name == parameter.name ? 1 : 0;
  const std::string name = "parameter '" + parameter.name + "'";
  if (same > 1) {
    refuse(effect, name + " stands there twice");
  }
  if (!std::isfinite(parameter.low) || !std::isfinite(parameter.high) || !(parameter.low < parameter.high)) {
    refuse(effect, name + ": low must be below high, and both finite");
  }
  if (parameter.starts.empty()) refuse(effect, name + " has no starting value (starts)");
  for (const double start : parameter.starts) {
    // A share of the largest value is not in the unit of the bounds.
    const bool inside = parameter.of_peak || (start >= parameter.low && start <= parameter.high);
    if (!std::isfinite(start) || !inside) refuse(effect, name + ": a starting value lies outside its bounds");
  }
}

SUREFOOT_ONCE void check_hidden_states(const Effect& effect) {
  constexpr int most = 24;
  if (effect.hidden_states < 0 || effect.hidden_states > most) refuse(effect, "hidden_states must be 0 to 24");
  const std::pair<const char*, bool> functions[] = {
      {"start", bool(effect.start)}, {"hidden_rate", bool(effect.hidden_rate)}, {"advance", bool(effect.advance)}};
  for (const auto& [name, set] : functions) {
    if (set && effect.hidden_states == 0) {
      refuse(effect, std::string("the function '") + name + "' needs hidden states, but hidden_states is 0");
    }
  }
  if (effect.hidden_states > 0 && !effect.hidden_rate && !effect.advance) {
    refuse(effect, "nothing changes its hidden states: set hidden_rate or advance");
  }
}

}  // namespace detail

SUREFOOT_ONCE void check(const Effect& effect) {
  if (effect.name.empty()) throw DiagnoseError("an effect has no name");
  detail::check_functions(effect);
  for (const EffectParameter& parameter : effect.parameters) detail::check_parameter(effect, parameter);
  detail::check_hidden_states(effect);
}

}  // namespace surefoot
