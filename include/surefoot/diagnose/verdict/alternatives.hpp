// Alternatives: what might stand in an effect's place, and what the recordings cannot tell apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/selection/search.hpp"

namespace surefoot::diagnosis {

/// When two hypotheses are held to be equally good. Gains are shares of the cross-validated root mean square error.
struct AlternativeCriteria {
  double clear_gain = 0.1;              // the choice is ahead by this much: told apart, however unsure the gain is
  double clear_t = 2;                   // or by this many standard errors of the gain,
  double negligible_gain = 0.01;        // unless it is this small
  double equal_share = 0.97;            // of the choice's gain: the rest may be due to the form of either effect
  std::uint32_t rounds = 400;           // of the bootstrap: a share is then off by 2.5 % at most (one standard error)
  double extra_parameter_ratio = 0.99;  // of errors: a hypothesis with more parameters has to be better by 1 %
};

/// Share of bootstrap repetitions (over blocks) in which `chosen` beats the parent and every alternative.
double bootstrap_confidence(const EvaluatedHypothesis& chosen, const BlockLosses& parent,
                            const std::vector<EvaluatedHypothesis>& others, std::uint64_t seed,
                            const AlternativeCriteria& criteria = {});

/// Evidence for one of the chosen effects, the first that is not known being number 0.
Evidence evidence_for(const Selection& selection, std::size_t effect, std::uint64_t seed,
                      const AlternativeCriteria& criteria = {});

/// Whether an alternative is as good as the choice: `lead` is what the choice gains over it, the gains are those over
/// the model without effects.
bool indistinguishable(const Comparison& lead, double chosen_gain, double other_gain,
                       const AlternativeCriteria& criteria);

/// Effects with the same names at the same places, perhaps in another form.
bool same_names(const Hypothesis& hypothesis, const Hypothesis& chosen);

/// Effects with their places, in plain text.
std::string names_of(const Hypothesis& hypothesis);

/// All that might have been chosen instead, best first.
struct Alternatives {
  std::vector<Alternative> list;
  std::vector<std::string> ties;                       // names of those that cannot be told apart
  std::vector<EvaluatedHypothesis> indistinguishable;  // the same
};

Alternatives find_alternatives(const Selection& selection, const AlternativeCriteria& criteria = {});

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/alternatives.ipp"
#endif
