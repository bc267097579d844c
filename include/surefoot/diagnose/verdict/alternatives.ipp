// Definitions of surefoot/diagnose/verdict/alternatives.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/text.hpp"
#include "surefoot/diagnose/verdict/alternatives.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Evidence evidence_for(const Selection& selection, std::size_t effect) {
  const Comparison gain = effect < selection.evidence.size() ? selection.evidence[effect] : Comparison{};
  const auto& effects = selection.chosen.hypothesis.effects;
  const AttachedEffect& mine = effects[selection.nominal.hypothesis.effects.size() + effect];
  double confidence = selection.probability;
  for (std::size_t i = 0; i < selection.alternatives.size(); ++i) {
    const auto& others = selection.alternatives[i].hypothesis.effects;
    const bool has_it =
        holds_for_any(others, [&](const AttachedEffect& other) { return same_but_for_form(other, mine); });
    if (has_it) confidence += selection.alternative_probabilities[i];
  }
  return {gain.gain, gain.stderr_, gain.p_value, std::min(1.0, confidence)};
}

SUREFOOT_ONCE std::string names_of(const Hypothesis& hypothesis, std::size_t known) {
  std::vector<std::string> names;
  for (std::size_t e = known; e < hypothesis.effects.size(); ++e) {
    std::string name = hypothesis.effects[e].effect->name;
    std::replace(name.begin(), name.end(), '_', ' ');
    names.push_back(name + " at " + hypothesis.effects[e].place);
  }
  return names.empty() ? "no effect at all" : in_list(names);
}

/// The effects of a structure, in words; alone, where all of them are among those that were chosen.
SUREFOOT_ONCE std::string tie_of(const Hypothesis& other, const Hypothesis& chosen, std::size_t known) {
  bool part = other.effects.size() < chosen.effects.size();
  for (std::size_t e = known; e < other.effects.size(); ++e) {
    part = part && holds_for_any(chosen.effects,
                                 [&](const AttachedEffect& one) { return same_but_for_form(one, other.effects[e]); });
  }
  return names_of(other, known) + (part ? " alone" : "");
}

SUREFOOT_ONCE Alternatives find_alternatives(const Selection& selection, const SelectionCriteria& criteria) {
  constexpr std::size_t most = 20;  // alternatives that are told: nobody reads more
  const std::size_t known = selection.nominal.hypothesis.effects.size();
  const bool found_any = selection.chosen.hypothesis.effects.size() > known;
  double most_probable = selection.probability;
  for (const double one : selection.alternative_probabilities) most_probable = std::max(most_probable, one);
  Alternatives result;
  for (std::size_t i = 0; i < std::min(most, selection.alternatives.size()); ++i) {
    const EvaluatedHypothesis& other = selection.alternatives[i];
    if (other.hypothesis.effects.size() <= known) continue;
    Alternative alternative;
    alternative.fitted_rmse = other.errors.rms();
    alternative.held_out_rmse = other.predicted;
    alternative.probability = selection.alternative_probabilities[i];
    for (std::size_t e = known; e < other.hypothesis.effects.size(); ++e) {
      alternative.effects.emplace_back(other.hypothesis.effects[e].effect->name, other.hypothesis.effects[e].place);
    }
    alternative.indistinguishable = found_any && criteria.tie_odds * alternative.probability > most_probable;
    if (alternative.indistinguishable) {
      result.ties.push_back(tie_of(other.hypothesis, selection.chosen.hypothesis, known));
      result.indistinguishable.push_back(other);
    }
    result.list.push_back(std::move(alternative));
  }
  return result;
}

}  // namespace surefoot::diagnosis
