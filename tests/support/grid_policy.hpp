// Near-optimal policies of small noise-free problems by dynamic programming on a grid: what learnt policies are held
// to.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "surefoot/core/problem.hpp"

namespace surefoot::toy {

/// Value iteration over `horizon` transitions on a regular grid with multilinear interpolation, then one-step
/// lookahead. For problems without noise. Cost: nodes * actions * (steps once, 2^state_dim reads per transition of the
/// horizon).
template <Problem P>
class GridPolicy {
 public:
  using State = typename P::State;
  using Action = typename P::Action;

  /// `points` grid points per state dimension, `choices` evenly spaced values per action dimension.
  GridPolicy(const P& problem, std::size_t points, std::size_t choices, int horizon)
      : problem_(problem), box_(problem.state_box()), points_(points) {
    const std::size_t nodes = power(points, P::state_dim);
    for (std::size_t i = 0; i < power(choices, P::action_dim); ++i) {
      actions_.push_back(grid_point(problem.action_box(), choices, i));
    }
    std::vector<Outcome> outcomes;
    for (std::size_t i = 0; i < nodes; ++i) {
      for (const Action& action : actions_) outcomes.push_back(outcome(grid_point(box_, points, i), action));
    }
    values_.assign(nodes, 0.0);
    for (int t = 0; t < horizon; ++t) {
      std::vector<double> next(nodes);
      for (std::size_t i = 0; i < nodes; ++i) {
        double best = -std::numeric_limits<double>::infinity();
        for (std::size_t a = 0; a < actions_.size(); ++a) {
          best = std::max(best, worth(outcomes[i * actions_.size() + a]));
        }
        next[i] = best;
      }
      values_ = std::move(next);
    }
  }

  Action operator()(const State& state) const {
    const Action* best = &actions_.front();
    double best_worth = -std::numeric_limits<double>::infinity();
    for (const Action& action : actions_) {
      const double w = worth(outcome(state, action));
      if (w > best_worth) {
        best_worth = w;
        best = &action;
      }
    }
    return *best;
  }

 private:
  static constexpr std::size_t corners = std::size_t{1} << P::state_dim;
  struct Outcome {
    double reward;
    std::size_t cell;                         // its lowest corner
    std::array<double, P::state_dim> inside;  // where in the cell, in [0, 1]
    bool terminal;
  };

  static std::size_t power(std::size_t base, int exponent) {
    std::size_t result = 1;
    for (int i = 0; i < exponent; ++i) result *= base;
    return result;
  }

  template <int N>
  static Vec<N> grid_point(const Box<N>& box, std::size_t points, std::size_t index) {
    Vec<N> unit;
    for (int i = 0; i < N; ++i, index /= points) {
      unit[i] = static_cast<double>(index % points) / static_cast<double>(points - 1);
    }
    return box.from_unit(unit);
  }

  Outcome outcome(const State& state, const Action& action) const {
    Rng rng(0);
    const Step<State> step = problem_.step(state, action, rng);
    const State unit = box_.to_unit(box_.clamp(step.next));
    Outcome result{step.reward, 0, {}, step.terminal};
    std::size_t stride = 1;
    for (int i = 0; i < P::state_dim; ++i, stride *= points_) {
      const double scaled = unit[i] * static_cast<double>(points_ - 1);
      const std::size_t low = std::min(static_cast<std::size_t>(scaled), points_ - 2);
      result.cell += low * stride;
      result.inside[static_cast<std::size_t>(i)] = scaled - static_cast<double>(low);
    }
    return result;
  }

  double worth(const Outcome& outcome) const {
    if (outcome.terminal) return outcome.reward;
    double value = 0;
    for (std::size_t corner = 0; corner < corners; ++corner) {
      double weight = 1;
      std::size_t node = outcome.cell;
      std::size_t stride = 1;
      for (std::size_t i = 0; i < P::state_dim; ++i, stride *= points_) {
        const bool upper = (corner >> i) & 1;
        weight *= upper ? outcome.inside[i] : 1 - outcome.inside[i];
        node += upper ? stride : 0;
      }
      value += weight * values_[node];
    }
    return outcome.reward + value;
  }

  P problem_;
  Box<P::state_dim> box_;
  std::size_t points_;
  std::vector<Action> actions_;
  std::vector<double> values_;
};

}  // namespace surefoot::toy
