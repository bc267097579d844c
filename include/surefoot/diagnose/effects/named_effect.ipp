// Definitions of surefoot/diagnose/effects/named_effect.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/effects/effect.hpp"
#include "surefoot/diagnose/effects/named_effect.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace surefoot {

SUREFOOT_INLINE AttachedEffect attach(const SimulatorInfo& info, const NamedEffect& named,
                                      const std::vector<Effect>& effects) {
  const auto index_in = [](const auto& list, const std::string& name) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
    return found == list.end() ? -1 : static_cast<int>(found - list.begin());
  };
  bool known = false;
  for (const Effect& effect : effects) {
    if (effect.name != named.name || effect.form != named.form) continue;
    known = true;
    int at = -1;
    switch (effect.place) {
      case Place::velocity:
      case Place::state:
        at = index_in(info.states, named.attached_to);
        break;
      case Place::input: {
        at = index_in(info.inputs, named.attached_to);
        const auto signal = std::find(info.signals.begin(), info.signals.end(), named.attached_to);
        if (at < 0 && signal != info.signals.end()) {
          at = static_cast<int>(info.inputs.size()) + static_cast<int>(signal - info.signals.begin());
        }
        break;
      }
      case Place::output:
        at = index_in(info.outputs, named.attached_to);
        break;
      case Place::planar:
        at = info.planar ? 0 : -1;
        break;
      case Place::parameter:
        at = index_in(info.parameters, named.attached_to);
        break;
    }
    if (at < 0) continue;  // perhaps another effect of that name attaches there
    if (named.values.size() != effect.parameters.size()) {
      throw DiagnoseError("effect '" + named.name + "' has " + std::to_string(effect.parameters.size()) +
                          " parameters, got " + std::to_string(named.values.size()));
    }
    const int other = named.other.empty() ? -1 : index_in(info.states, named.other);
    if (!named.other.empty() && other < 0)
      throw DiagnoseError("effect '" + named.name + "': there is no state '" + named.other + "'");
    return {std::make_shared<const Effect>(effect), at, other, named.attached_to, 0};
  }
  if (known) throw DiagnoseError("effect '" + named.name + "' cannot attach to '" + named.attached_to + "'");
  std::string names;
  for (const Effect& effect : effects) {
    if (names.find(effect.name) == std::string::npos) names += (names.empty() ? "" : ", ") + effect.name;
  }
  throw DiagnoseError("there is no effect '" + named.name + "'" +
                      (named.form.empty() ? "" : " of form '" + named.form + "'") + "; there are: " + names);
}

}  // namespace surefoot
