// Effects by name: how model files and generated code say them.
#pragma once

#include <string>
#include <vector>

#include "surefoot/diagnose/effects/effect.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace surefoot {

/// One effect by its names; values in the units of the model, in the order of the effect's parameters.
struct NamedEffect {
  std::string name, attached_to;
  std::string form = {}, other = {};
  std::vector<double> values = {};
  std::vector<EffectBounds> bounds = {};  // of the values; empty: those of the library
};

/// Finds an effect and its place in a simulator. Throws a DiagnoseError that lists what there is.
AttachedEffect attach(const SimulatorInfo& info, const NamedEffect& named, const std::vector<Effect>& effects);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/effects/named_effect.ipp"
#endif
