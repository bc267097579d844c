// Fails unless the compiled library knows dry friction.
#include <algorithm>

#include "surefoot/diagnose/effects/catalogue.hpp"

int main() {
  const auto is_friction = [](const surefoot::Effect& effect) { return effect.name == "coulomb_friction"; };
  const auto effects = surefoot::all_effects();
  return std::any_of(effects.begin(), effects.end(), is_friction) ? 0 : 1;
}
