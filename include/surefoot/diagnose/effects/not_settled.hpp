// An effect whose hidden states a recording may find anywhere: under way, under load, somewhere within its gap.
// Without this it begins as if what it is attached to had always been as in the first row.
#pragma once

#include "surefoot/diagnose/effects/effect.hpp"

namespace surefoot::effects {

/// The same effect where each recording tells how far its first hidden state is from where `start` puts it.
[[gnu::cold]] inline Effect not_settled(const Effect& settled) {
  Effect effect = settled;
  effect.form = settled.form.empty() ? "not settled" : settled.form + ", not settled";
  effect.extends = {settled.form};
  if (settled.place == Place::input) effect.extends.emplace_back("from rest");
  effect.sentence += ", not settled when recordings begin";
  effect.starts_anywhere = true;
  return effect;
}

}  // namespace surefoot::effects
