// The data of an effect from constants: the same as from strings and vectors, each of which costs the compiler much
// code that clears up behind it.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// As EffectParameter.
struct ParameterConstants {
  const char* name = "";
  Measure measure = {};
  double low = 0, high = 1;
  std::initializer_list<double> starts = {};
  bool strength = false, of_peak = false, beyond_least = false;
};

[[gnu::cold, gnu::noinline]] inline std::vector<EffectParameter> parameters_of(
    std::initializer_list<ParameterConstants> constants) {
  std::vector<EffectParameter> parameters;
  for (const ParameterConstants& one : constants) {
    parameters.push_back(
        {one.name, one.measure, one.low, one.high, one.starts, one.strength, one.of_peak, one.beyond_least});
  }
  return parameters;
}

[[gnu::cold, gnu::noinline]] inline std::vector<std::string> names_of(std::initializer_list<const char*> constants) {
  return {constants.begin(), constants.end()};
}

}  // namespace surefoot::effects
