// Alternatives: what might stand in an effect's place, and what the recordings cannot tell apart.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/selection/search.hpp"

namespace surefoot::diagnosis {

/// Evidence for one of the chosen effects, the first that is not known being number 0.
Evidence evidence_for(const Selection& selection, std::size_t effect);

/// Effects with their places, in plain text.
std::string names_of(const Hypothesis& hypothesis, std::size_t known = 0);

/// All that might have been chosen instead, best first.
struct Alternatives {
  std::vector<Alternative> list;
  std::vector<std::string> ties;                       // names of those that cannot be told apart
  std::vector<EvaluatedHypothesis> indistinguishable;  // the same
};

Alternatives find_alternatives(const Selection& selection, const SelectionCriteria& criteria = {});

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/alternatives.ipp"
#endif
