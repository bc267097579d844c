// Definitions of surefoot/diagnose/options.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/options.hpp"
#include "surefoot/diagnose/text.hpp"

namespace surefoot {

/// Names of effects, each once, whatever their forms.
SUREFOOT_ONCE std::vector<std::string> distinct_names(const std::vector<Effect>& effects) {
  std::vector<std::string> names;
  for (const Effect& effect : effects) {
    if (std::find(names.begin(), names.end(), effect.name) == names.end()) names.push_back(effect.name);
  }
  return names;
}

SUREFOOT_ONCE void check(const DiagnoseOptions& options) {
  const auto fail = [](const std::string& text) { throw DiagnoseError("DiagnoseOptions::" + text); };
  for (std::size_t i = 0; i < options.held_out.size(); ++i) {
    if (std::count(options.held_out.begin(), options.held_out.end(), options.held_out[i]) > 1) {
      fail("held_out names '" + options.held_out[i] + "' more than once: name each recording once");
    }
  }
  if (!(options.held_out_share >= 0 && options.held_out_share <= 1)) {
    fail("held_out_share must be between 0 and 1, not " + std::to_string(options.held_out_share));
  }
  for (std::size_t i = 0; i < options.more_effects.size(); ++i) {
    if (options.more_effects[i].name.empty()) {
      fail("more_effects[" + std::to_string(i) + "] has no name: give it one, results and reports speak of it by name");
    }
    check(options.more_effects[i]);
  }
  std::vector<Effect> every = all_effects();
  for (const Effect& effect : options.more_effects) every.push_back(effect);
  const auto exists = [&](const std::string& name) {
    return std::any_of(every.begin(), every.end(), [&](const Effect& effect) { return effect.name == name; });
  };
  for (const std::string& name : options.effects) {
    if (!exists(name)) {
      fail("effects: there is no effect called '" + name +
           "'; there are " + in_list(distinct_names(every)) + " (in C++, more_effects adds your own)");
    }
  }
  for (const NamedEffect& known : options.known) {
    if (!std::all_of(known.values.begin(), known.values.end(), [](double value) { return std::isfinite(value); })) {
      fail("known: a parameter of '" + known.name +
           "' is not a finite number; give the value it has, or leave the "
           "effect out");
    }
  }
  if (options.max_effects < 0) {
    fail("max_effects must not be negative; 0 looks for no effects, and " + std::to_string(options.max_effects) +
         " was given");
  }
  if (options.max_rows < 2) {
    fail("max_rows must be 2 at least, and " + std::to_string(options.max_rows) + " was given; its default is " +
         std::to_string(DiagnoseOptions{}.max_rows));
  }
  if (!(options.max_seconds > 0)) {
    fail("max_seconds must be above 0; leave it at infinity for no limit");
  }
}

}  // namespace surefoot
