// Definitions of surefoot/diagnose/selection/grow.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/selection/choose_holds.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/selection/extend.hpp"
#include "surefoot/diagnose/selection/first_effects.hpp"
#include "surefoot/diagnose/selection/grow.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> extended(Search& search, const std::vector<EvaluatedHypothesis>& beam,
                                                        const EvaluatedHypothesis& best) {
  std::vector<EvaluatedHypothesis> children;
  for (const EvaluatedHypothesis& parent : beam) {
    if (!search.problem.stopped()) extend(search, parent, best, children);
  }
  return children;
}

SUREFOOT_ONCE std::vector<EvaluatedHypothesis> smaller(const Search& search, const EvaluatedHypothesis& whole) {
  const SearchProblem& problem = search.problem;
  std::vector<EvaluatedHypothesis> rests;
  if (search.effects(whole) < 2) return rests;
  for (std::size_t e = problem.known; e < whole.hypothesis.effects.size() && !problem.stopped(); ++e) {
    rests.push_back(search.without(whole, e));
  }
  return rests;
}

SUREFOOT_ONCE void draw_inside(const Search& search, const EvaluatedHypothesis& best,
                               std::vector<EvaluatedHypothesis>& children) {
  for (EvaluatedHypothesis& child : children) {
    if (search.problem.stopped()) return;
    child = inside_bounds(search, child, log_odds(child, best, search.problem.criteria));
  }
}

/// The structure that leaves least, however many parameters that takes; none of none.
SUREFOOT_ONCE std::optional<EvaluatedHypothesis> least_left(const std::vector<EvaluatedHypothesis>& some) {
  const EvaluatedHypothesis* least = nullptr;
  for (const EvaluatedHypothesis& one : some) {
    if (least == nullptr || one.errors.rms() < least->errors.rms()) least = &one;
  }
  return least == nullptr ? std::nullopt : std::optional(*least);
}

/// Whether an effect takes away more than any further one does by chance.
SUREFOOT_ONCE bool much_less(double left, double before) {
  constexpr double share = 0.8;  // of the mean square: few independent errors bend by a tenth to any parameter
  return left * left < share * before * before;
}

/// The same of two structures, beyond the noise.
SUREFOOT_ONCE bool much_less_beyond_noise(const EvaluatedHypothesis& one, const EvaluatedHypothesis& before,
                                          const SearchProblem& problem) {
  const double noise = problem.noise.sum();
  const auto beyond = [noise](const EvaluatedHypothesis& it) {
    return std::sqrt(std::max(0.0, pooled(it.errors).sum() - noise));
  };
  return much_less(beyond(one), beyond(before));
}

SUREFOOT_ONCE void add_structure(std::vector<EvaluatedHypothesis>& some, const EvaluatedHypothesis& one) {
  const bool there = holds_for_any(
      some, [&](const EvaluatedHypothesis& other) { return same_structure(other.hypothesis, one.hypothesis); });
  if (!there) some.push_back(one);
}

SUREFOOT_ONCE bool pays(const Search& search, const EvaluatedHypothesis& one,
                        const std::vector<EvaluatedHypothesis>& pool) {
  const auto none = find_item(pool, [&](const auto& other) { return search.effects(other) == 0; });
  const bool less_probable = none != nullptr && log_odds(one, *none, search.problem.criteria) < 0;
  return search.effects(one) > 0 && !less_probable;
}

SUREFOOT_ONCE void add_with_smaller(const Search& search, const EvaluatedHypothesis& one,
                                    std::vector<EvaluatedHypothesis>& beam) {
  add_structure(beam, one);
  for (const EvaluatedHypothesis& rest : smaller(search, one)) {
    if (!much_less(one.errors.rms(), rest.errors.rms())) add_structure(beam, rest);
  }
}

SUREFOOT_ONCE void grow(Search& search, std::vector<EvaluatedHypothesis>& pool, std::vector<Hypothesis>& done) {
  const SelectionCriteria& criteria = search.problem.criteria;
  const SearchEffort& effort = search.problem.effort;
  std::vector<EvaluatedHypothesis> beam = best_structures(pool, effort.beam, effort.hopeless, criteria);
  bool in_vain = false;  // a first step that does not pay may lead to one that does; two in a row only by coming nearer
  double nearest = pool[best_of(pool, criteria)].errors.rms();
  for (int depth = 0; depth < criteria.max_effects && !search.problem.stopped(); ++depth) {
    search.problem.on_progress("searching effect " + std::to_string(depth + 1),
                               static_cast<double>(depth) / criteria.max_effects);
    const EvaluatedHypothesis best = pool[best_of(pool, criteria)];
    const auto most = static_cast<std::size_t>(criteria.max_effects);
    drop_items(beam, [&](const EvaluatedHypothesis& one) {
      return search.effects(one) >= most || is_among(one.hypothesis, done);
    });
    for (const EvaluatedHypothesis& one : beam) done.push_back(one.hypothesis);
    const bool first = search.effects(best) == 0 && depth == 0;
    std::vector<EvaluatedHypothesis> children = first ? first_effects(search, best) : extended(search, beam, best);
    enrich(search, children, std::numeric_limits<double>::infinity(), ErrorsOfForm::tolerated);
    draw_inside(search, best, children);
    for (const EvaluatedHypothesis& child : children) keep_best_form(pool, child, criteria);
    if (depth == 0 && yields(search, pool)) break;
    const EvaluatedHypothesis now = pool[best_of(pool, criteria)];
    const bool no_better = same_structure(now.hypothesis, best.hypothesis) || log_odds(now, best, criteria) < 0;
    const auto nearest_child = least_left(children);
    const bool nearer = nearest_child && much_less(nearest_child->errors.rms(), nearest);
    if (nearer) nearest = nearest_child->errors.rms();
    if (no_better && ((in_vain && !nearer) || pays(search, now, pool) || !leaves_structure(search, now))) break;
    // beside effects, little steps bend what is not understood, one after the other
    if (!first && !no_better && !nearer && !much_less_beyond_noise(now, best, search.problem)) break;
    in_vain = no_better;
    drop_items(children, [&](const EvaluatedHypothesis& one) {
      return holds_idle_effect(one, pool) || log_odds(one, now, criteria) < -effort.hopeless;
    });
    beam = best_structures(children, effort.beam, effort.hopeless, criteria);
    if (no_better && nearer) add_with_smaller(search, *nearest_child, beam);
    if (beam.empty()) break;
    reweight(search, now);
    Fit fitted{now.hypothesis, now.loss, true};
    const bool holds = choose_holds(search.bound, fitted, search.problem, search.parallel);
    const bool otherwise = refine_integration(search, now) || holds;
    if (otherwise) {
      pool = fitted_again(search, pool);  // compared with the same errors
      done.clear();
    }
    for (EvaluatedHypothesis& one : beam) {  // and with the weights of their children
      const auto again = find_item(
          pool, [&](const EvaluatedHypothesis& other) { return same_structure(other.hypothesis, one.hypothesis); });
      if (otherwise && again != nullptr) {
        one = *again;
      } else {
        one = refitted(search, one.hypothesis);
        keep_best_form(pool, one, criteria);
      }
    }
    if (no_better) continue;
    for (const EvaluatedHypothesis& rest : smaller(search, pool[best_of(pool, criteria)])) {
      const bool hopeless = log_odds(rest, now, criteria) < -effort.hopeless;
      if (keep_best_form(pool, rest, criteria) && !hopeless) beam.push_back(rest);
    }
  }
}

}  // namespace surefoot::diagnosis
