// Laws and names of the effects that may be hidden.
#pragma once

#include <string>

#include "draw_effects.hpp"

namespace machines {

/// A law for an effect at its place, and whether it is the library's formula.
Law draw_law(Random& random, const Grammar& grammar, const Candidate& candidate, bool& same);

/// As the truth calls it: a sentence for what is outside the library.
std::string full_name(const std::string& name);

/// As the library calls the parameter that is Hidden::a.
std::string name_of_strength(const std::string& name);

/// Fills in the name of the place, and others that mean it: of what a speed moves, what reads it, constant multiples of
/// a signal.
void name_place(Hidden& one, const Machine& machine, Where where);

}  // namespace machines
