// Definitions of surefoot/diagnose/verdict/describe.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/estimation/fit.hpp"
#include "surefoot/diagnose/selection/criterion.hpp"
#include "surefoot/diagnose/text.hpp"
#include "surefoot/diagnose/verdict/describe.hpp"

namespace surefoot::diagnosis {

SUREFOOT_INLINE std::vector<CalibratedParameter> calibrated_parameters(const BoundSimulator& bound,
                                                                       const Hypothesis& hypothesis,
                                                                       const StandardErrors& errors) {
  std::vector<CalibratedParameter> result;
  for (std::size_t i = 0; i < bound.info.parameters.size(); ++i) {
    const ParameterInfo& info = bound.info.parameters[i];
    const double value = hypothesis.parameters[static_cast<Eigen::Index>(i)];
    CalibratedParameter one{{info.name, info.unit, value, value, value}, info.value, false, info.fixed};
    for (std::size_t v = 0; v < errors.variables.size(); ++v) {
      const Variable& variable = errors.variables[v];
      if (variable.kind != Variable::Kind::parameter || variable.index != i) continue;
      const double half = 1.96 * errors.deviation[static_cast<Eigen::Index>(v)];
      one.fit.low = std::max(value - half, info.low);
      one.fit.high = std::min(value + half, info.high);
      const double near = 1e-3 * (info.high - info.low);
      one.at_bound =
          value <= info.low + near * (variable.logarithmic ? value / info.high : 1) || value >= info.high - near;
    }
    result.push_back(one);
  }
  return result;
}

SUREFOOT_INLINE std::vector<std::string> correlated_pairs(const BoundSimulator& bound, const StandardErrors& errors) {
  std::vector<std::string> result;
  for (std::size_t a = 0; a < errors.variables.size(); ++a) {
    for (std::size_t b = a + 1; b < errors.variables.size(); ++b) {
      if (errors.variables[a].kind != Variable::Kind::parameter ||
          errors.variables[b].kind != Variable::Kind::parameter)
        continue;
      const double r = errors.correlation(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      if (std::abs(r) < 0.95) continue;
      result.push_back(bound.info.parameters[errors.variables[a].index].name + " and " +
                       bound.info.parameters[errors.variables[b].index].name + " (correlation " + in_digits(r) + ")");
    }
  }
  return result;
}

SUREFOOT_INLINE FoundEffect describe(const BoundSimulator& bound, const Hypothesis& hypothesis, std::size_t e,
                                     const StandardErrors* errors) {
  const AttachedEffect& attached = hypothesis.effects[e];
  FoundEffect found;
  found.name = attached.effect->name;
  found.attached_to = attached.place;
  found.form = attached.effect->form;
  if (attached.other >= 0) found.other = bound.info.states[static_cast<std::size_t>(attached.other)].name;
  const auto& parameters = attached.effect->parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double value = hypothesis.values[e][static_cast<Eigen::Index>(k)];
    FittedValue one{parameters[k].name, measure_unit(bound, attached, parameters[k].measure), value, value, value};
    if (errors != nullptr) {
      for (std::size_t v = 0; v < errors->variables.size(); ++v) {
        const Variable& variable = errors->variables[v];
        if (variable.kind != Variable::Kind::effect || variable.index != e || variable.item != k) continue;
        const double half = 1.96 * errors->deviation[static_cast<Eigen::Index>(v)];
        one.low = value - half;
        one.high = value + half;
      }
    }
    found.parameters.push_back(one);
  }
  found.sentence = fill_sentence(attached.effect->sentence, attached.place, found.parameters);
  return found;
}

SUREFOOT_INLINE double bootstrap_confidence(const EvaluatedHypothesis& chosen, const BlockLosses& parent,
                                            const std::vector<EvaluatedHypothesis>& others, std::uint64_t seed) {
  const std::size_t n = chosen.heldout.blocks.size();
  if (n == 0) return 0;
  Rng rng(seed, 0xb007u);
  int wins = 0;
  constexpr int rounds = 400;
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> sums(others.size() + 2);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t b = rng.below(static_cast<std::uint32_t>(n));
      sums[0] += chosen.heldout.blocks[b];
      sums[1] += parent.blocks[b];
      for (std::size_t o = 0; o < others.size(); ++o) sums[o + 2] += others[o].heldout.blocks[b];
    }
    bool best = sums[0] < sums[1];
    for (std::size_t o = 0; o < others.size(); ++o) {
      // a model with more numbers has to be better by more than one per cent
      const double margin = others[o].numbers() > chosen.numbers() ? 0.99 : 1;
      best = best && sums[0] <= sums[o + 2] / margin;
    }
    wins += best ? 1 : 0;
  }
  return static_cast<double>(wins) / rounds;
}

}  // namespace surefoot::diagnosis
