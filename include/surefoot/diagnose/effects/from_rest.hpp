// An effect with a memory of an input, on a machine that was not told anything before the first row: the input was 0
// until then. Without this the first value counts for all that was before.
#pragma once

#include <string>

#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// The same effect where its input was 0 before the first row; hidden states begin at zero.
[[gnu::cold]] inline Effect from_rest(const Effect& without) {
  Effect effect = without;
  effect.form += without.form.empty() ? "from rest" : ", from rest";
  for (std::string& form : effect.extends) form += form.empty() ? "from rest" : ", from rest";
  effect.from_rest = true;
  effect.start = {};
  return effect;
}

}  // namespace surefoot::effects
