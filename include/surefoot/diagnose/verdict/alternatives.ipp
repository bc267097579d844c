// Definitions of surefoot/diagnose/verdict/alternatives.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/text.hpp"
#include "surefoot/diagnose/verdict/alternatives.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE double bootstrap_confidence(const EvaluatedHypothesis& chosen, const BlockLosses& parent,
                                            const std::vector<EvaluatedHypothesis>& others, std::uint64_t seed,
                                            const AlternativeCriteria& criteria) {
  const std::size_t n = chosen.cross_validated.blocks.size();
  if (n == 0) return 0;
  Rng rng(seed, 0xb007u);
  std::uint32_t wins = 0;
  for (std::uint32_t round = 0; round < criteria.rounds; ++round) {
    std::vector<double> sums(others.size() + 2);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t b = rng.below(static_cast<std::uint32_t>(n));
      sums[0] += chosen.cross_validated.blocks[b];
      sums[1] += parent.blocks[b];
      for (std::size_t o = 0; o < others.size(); ++o) sums[o + 2] += others[o].cross_validated.blocks[b];
    }
    bool best = sums[0] < sums[1];
    for (std::size_t o = 0; o < others.size(); ++o) {
      const bool larger = others[o].parameter_count() > chosen.parameter_count();
      best = best && sums[0] <= sums[o + 2] / (larger ? criteria.extra_parameter_ratio : 1);
    }
    wins += best ? 1 : 0;
  }
  return static_cast<double>(wins) / criteria.rounds;
}

SUREFOOT_INLINE Evidence evidence_for(const Selection& selection, std::size_t effect, std::uint64_t seed,
                                      const AlternativeCriteria& criteria) {
  const Comparison gain = effect < selection.evidence.size() ? selection.evidence[effect] : Comparison{};
  std::vector<EvaluatedHypothesis> rivals;
  for (const EvaluatedHypothesis& other : selection.alternatives) {
    if (other.hypothesis.effects.size() == selection.chosen.hypothesis.effects.size()) rivals.push_back(other);
  }
  return {gain.gain, gain.stderr_, std::min(1.0, gain.p_value * static_cast<double>(selection.candidates)),
          bootstrap_confidence(selection.chosen, selection.nominal.cross_validated, rivals, seed, criteria)};
}

SUREFOOT_INLINE bool indistinguishable(const Comparison& lead, double chosen_gain, double other_gain,
                                       const AlternativeCriteria& criteria) {
  const bool level =
      lead.gain < criteria.clear_gain && (lead.t < criteria.clear_t || lead.gain < criteria.negligible_gain);
  return level || other_gain > criteria.equal_share * chosen_gain;
}

SUREFOOT_INLINE bool same_names(const Hypothesis& hypothesis, const Hypothesis& chosen) {
  return std::ranges::all_of(hypothesis.effects, [&](const AttachedEffect& effect) {
    return std::ranges::any_of(chosen.effects, [&](const AttachedEffect& mine) {
      return mine.effect->name == effect.effect->name && mine.at == effect.at &&
             mine.effect->place == effect.effect->place;
    });
  });
}

SUREFOOT_INLINE std::string names_of(const Hypothesis& hypothesis) {
  std::vector<std::string> names;
  for (const AttachedEffect& effect : hypothesis.effects) {
    std::string name = effect.effect->name;
    std::ranges::replace(name, '_', ' ');
    names.push_back(name + " at " + effect.place);
  }
  return in_list(names);
}

SUREFOOT_INLINE Alternatives find_alternatives(const Selection& selection, const AlternativeCriteria& criteria) {
  const Hypothesis& chosen = selection.chosen.hypothesis;
  const BlockLosses& without = selection.nominal.cross_validated;
  const bool found_any = chosen.effects.size() > selection.nominal.hypothesis.effects.size();
  std::vector<EvaluatedHypothesis> others = selection.alternatives;
  sort_items(others, [](const EvaluatedHypothesis& a, const EvaluatedHypothesis& b) {
    return a.cross_validated.total() < b.cross_validated.total();
  });
  const double chosen_gain = 1 - selection.chosen.cross_validated.rms() / without.rms();
  Alternatives result;
  for (const EvaluatedHypothesis& other : others) {
    if (same_names(other.hypothesis, chosen)) continue;  // another form of the same
    Alternative alternative;
    alternative.cross_validated_rmse = other.cross_validated.rms();
    for (const AttachedEffect& effect : other.hypothesis.effects)
      alternative.effects.emplace_back(effect.effect->name, effect.place);
    const Comparison lead = compare_losses(other.cross_validated, selection.chosen.cross_validated);
    const double other_gain = 1 - other.cross_validated.rms() / without.rms();
    alternative.indistinguishable = found_any && indistinguishable(lead, chosen_gain, other_gain, criteria);
    if (alternative.indistinguishable) {
      result.ties.push_back(names_of(other.hypothesis));
      result.indistinguishable.push_back(other);
    }
    result.list.push_back(std::move(alternative));
  }
  return result;
}

}  // namespace surefoot::diagnosis
