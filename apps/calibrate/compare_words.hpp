// What a change of a walk means, in words.
#pragma once

#include <string>
#include <vector>

#include "surefoot/motion/walk_changes.hpp"

namespace calibrate_program {

/// Everything that is said about what changed, a sentence each; about nothing, if nothing was found.
std::vector<std::string> change_sentences(const surefoot::WalkComparison& comparison,
                                          const std::optional<surefoot::WalkFalls>& falls);

/// The likeliest change in words, with its probability.
std::string likeliest_change(const surefoot::WalkComparison& comparison,
                             const std::optional<surefoot::WalkFalls>& falls);

/// What can cause such changes, as far as displacements tell causes apart: a sentence for each kind of change found.
std::vector<std::string> possible_causes(const surefoot::WalkComparison& comparison);

/// The name of a change, as in the sentences: of a coefficient its own; -1 is a delay of whole cycles.
std::string name_of_change(const surefoot::WalkComparison& comparison, int change);

}  // namespace calibrate_program
