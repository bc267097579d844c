// Describes what was fitted: parameters, effects and how sure each is.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/fit.hpp"
#include "surefoot/diagnose/judge.hpp"
#include "surefoot/diagnose/wording.hpp"

namespace surefoot::detail {

inline std::vector<CalibratedParameter> calibrated_parameters(const Rig& rig, const Hypothesis& hypothesis,
                                                              const StandardErrors& errors) {
  std::vector<CalibratedParameter> result;
  for (std::size_t i = 0; i < rig.info.parameters.size(); ++i) {
    const ParameterInfo& info = rig.info.parameters[i];
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

inline std::vector<std::string> correlated_pairs(const Rig& rig, const StandardErrors& errors) {
  std::vector<std::string> result;
  for (std::size_t a = 0; a < errors.variables.size(); ++a) {
    for (std::size_t b = a + 1; b < errors.variables.size(); ++b) {
      if (errors.variables[a].kind != Variable::Kind::parameter ||
          errors.variables[b].kind != Variable::Kind::parameter)
        continue;
      const double r = errors.correlation(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      if (std::abs(r) < 0.95) continue;
      result.push_back(rig.info.parameters[errors.variables[a].index].name + " and " +
                       rig.info.parameters[errors.variables[b].index].name + " (correlation " + in_digits(r) + ")");
    }
  }
  return result;
}

inline FoundEffect describe(const Rig& rig, const Hypothesis& hypothesis, std::size_t e, const StandardErrors* errors) {
  const AttachedEffect& attached = hypothesis.effects[e];
  FoundEffect found;
  found.name = attached.effect->name;
  found.attached_to = attached.place;
  found.form = attached.effect->form;
  if (attached.other >= 0) found.other = rig.info.states[static_cast<std::size_t>(attached.other)].name;
  const auto& parameters = attached.effect->parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double value = hypothesis.values[e][static_cast<Eigen::Index>(k)];
    FittedValue one{parameters[k].name, measure_unit(rig, attached, parameters[k].measure), value, value, value};
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

/// Share of bootstrap repetitions (over blocks) in which `chosen` beats the parent and every alternative.
inline double bootstrap_confidence(const Judged& chosen, const Score& parent, const std::vector<Judged>& others,
                                   std::uint64_t seed) {
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

}  // namespace surefoot::detail
