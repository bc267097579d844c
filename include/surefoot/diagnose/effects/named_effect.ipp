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

namespace detail {

/// Index of the item of that name, or -1.
template <class List>
int index_in(const List& list, const std::string& name) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

/// Where an effect of this place attaches if it is told this name, or -1.
SUREFOOT_ONCE int place_of(const SimulatorInfo& info, Place place, const std::string& name) {
  switch (place) {
    case Place::velocity:
    case Place::state:
      return index_in(info.states, name);
    case Place::input: {
      const auto signal = std::find(info.signals.begin(), info.signals.end(), name);
      const int input = index_in(info.inputs, name);
      if (input >= 0 || signal == info.signals.end()) return input;
      return static_cast<int>(info.inputs.size()) + static_cast<int>(signal - info.signals.begin());
    }
    case Place::output:
      return index_in(info.outputs, name);
    case Place::planar:
      return info.planar ? 0 : -1;
    case Place::parameter:
      break;
  }
  return index_in(info.parameters, name);
}

[[noreturn]] SUREFOOT_INLINE void refuse_unknown(const NamedEffect& named, const std::vector<Effect>& effects) {
  std::string names;
  for (const Effect& effect : effects) {
    if (names.find(effect.name) == std::string::npos) names += (names.empty() ? "" : ", ") + effect.name;
  }
  throw DiagnoseError("there is no effect '" + named.name + "'" +
                      (named.form.empty() ? "" : " of form '" + named.form + "'") + "; there are: " + names);
}

}  // namespace detail

SUREFOOT_ONCE AttachedEffect attach(const SimulatorInfo& info, const NamedEffect& named,
                                    const std::vector<Effect>& effects) {
  bool known = false;
  for (const Effect& effect : effects) {
    if (effect.name != named.name || effect.form != named.form) continue;
    known = true;
    const int at = detail::place_of(info, effect.place, named.attached_to);
    if (at < 0) continue;  // perhaps another effect of that name attaches there
    check(effect);
    if (named.values.size() != effect.parameters.size()) {
      throw DiagnoseError("effect '" + named.name + "' has " + std::to_string(effect.parameters.size()) +
                          " parameters, got " + std::to_string(named.values.size()));
    }
    const int other = named.other.empty() ? -1 : detail::index_in(info.states, named.other);
    if (!named.other.empty() && other < 0) {
      throw DiagnoseError("effect '" + named.name + "': there is no state '" + named.other + "'");
    }
    if (!named.bounds.empty() && named.bounds.size() != named.values.size()) {
      throw DiagnoseError("effect '" + named.name + "' has " + std::to_string(named.values.size()) +
                          " values, but bounds for " + std::to_string(named.bounds.size()));
    }
    return {std::make_shared<const Effect>(effect), at, other, named.attached_to, 0, named.bounds};
  }
  if (known) throw DiagnoseError("effect '" + named.name + "' cannot attach to '" + named.attached_to + "'");
  detail::refuse_unknown(named, effects);
}

}  // namespace surefoot
