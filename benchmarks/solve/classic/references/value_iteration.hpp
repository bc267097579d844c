// Value iteration on a grid, for problems of two or three dimensions without noise.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "reference.hpp"
#include "surefoot/core/box.hpp"

namespace classic {

/// Values at the points of a grid over the state box, linear between them.
template <int N>
class Grid {
 public:
  using Point = surefoot::Vec<N>;

  Grid(const surefoot::Box<N>& box, const std::array<int, N>& points, const std::array<bool, N>& periodic)
      : box_(box), points_(points), periodic_(periodic) {
    std::size_t count = 1;
    for (int i = 0; i < N; ++i) {
      stride_[at(i)] = count;
      count *= static_cast<std::size_t>(points[at(i)]);
    }
    values_.assign(count, 0.0F);
  }

  std::size_t size() const { return values_.size(); }
  float& operator[](std::size_t index) { return values_[index]; }

  Point point(std::size_t index) const {
    Point unit;
    for (int i = 0; i < N; ++i) {
      const auto here = index / stride_[at(i)] % static_cast<std::size_t>(points_[at(i)]);
      unit[i] = static_cast<double>(here) / intervals(i);
    }
    return box_.from_unit(unit);
  }

  double value(const Point& state) const {
    std::array<std::size_t, N> low, high;
    std::array<double, N> share;
    for (int i = 0; i < N; ++i) {
      const auto k = at(i);
      const double unit = (state[i] - box_.low()[i]) / box_.width()[i] * intervals(i);
      if (periodic_[k]) {
        const double floor = std::floor(unit);
        const int cell = ((static_cast<int>(floor) % points_[k]) + points_[k]) % points_[k];
        share[k] = unit - floor;
        low[k] = static_cast<std::size_t>(cell) * stride_[k];
        high[k] = static_cast<std::size_t>((cell + 1) % points_[k]) * stride_[k];
      } else {
        const double inside = std::clamp(unit, 0.0, intervals(i));
        const auto cell = std::min(static_cast<std::size_t>(inside), static_cast<std::size_t>(points_[k] - 2));
        share[k] = inside - static_cast<double>(cell);
        low[k] = cell * stride_[k];
        high[k] = low[k] + stride_[k];
      }
    }
    double sum = 0;
    for (std::size_t corner = 0; corner < (std::size_t{1} << N); ++corner) {
      double weight = 1;
      std::size_t index = 0;
      for (std::size_t k = 0; k < N; ++k) {
        const bool upper = ((corner >> k) & 1U) != 0;
        weight *= upper ? share[k] : 1 - share[k];
        index += upper ? high[k] : low[k];
      }
      if (weight > 0) sum += weight * static_cast<double>(values_[index]);
    }
    return sum;
  }

 private:
  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
  double intervals(int i) const { return periodic_[at(i)] ? points_[at(i)] : points_[at(i)] - 1; }

  surefoot::Box<N> box_;
  std::array<int, N> points_;
  std::array<bool, N> periodic_;
  std::array<std::size_t, N> stride_{};
  std::vector<float> values_;
};

struct GridOptions {
  double discount = 1;
  int sweeps = 100;       // at most
  double settled = 1e-4;  // it ends when no value changes by more
  double floor = -1000;   // no value below
};

/// Evenly spread actions, `counts` of them along each dimension.
template <int M>
std::vector<surefoot::Vec<M>> action_grid(const surefoot::Box<M>& box, const std::array<int, M>& counts) {
  std::vector<surefoot::Vec<M>> actions;
  std::size_t all = 1;
  for (const int count : counts) all *= static_cast<std::size_t>(count);
  for (std::size_t index = 0; index < all; ++index) {
    surefoot::Vec<M> unit;
    std::size_t rest = index;
    for (int i = 0; i < M; ++i) {
      const auto count = static_cast<std::size_t>(counts[static_cast<std::size_t>(i)]);
      unit[i] = count > 1 ? static_cast<double>(rest % count) / static_cast<double>(count - 1) : 0.5;
      rest /= count;
    }
    actions.push_back(box.from_unit(unit));
  }
  return actions;
}

/// The return of the policy that is greedy on the values of a grid.
template <surefoot::Problem P>
Reference grid_reference(const P& problem, const std::array<int, P::state_dim>& points,
                         const std::array<bool, P::state_dim>& periodic, const std::array<int, P::action_dim>& counts,
                         const GridOptions& options) {
  Grid<P::state_dim> grid(problem.state_box(), points, periodic);
  const auto actions = action_grid<P::action_dim>(problem.action_box(), counts);
  const auto best = [&](const typename P::State& state) {
    std::size_t chosen = 0;
    double value = 0;
    surefoot::Rng none(0);
    for (std::size_t a = 0; a < actions.size(); ++a) {
      const auto step = problem.step(state, actions[a], none);
      const double q = step.reward + (step.terminal ? 0.0 : options.discount * grid.value(step.next));
      if (a == 0 || q > value) {
        value = q;
        chosen = a;
      }
    }
    return std::pair(chosen, value);
  };
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    double change = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {  // in place, forwards and backwards in turn
      const std::size_t index = sweep % 2 == 0 ? i : grid.size() - 1 - i;
      const double value = std::max(options.floor, best(grid.point(index)).second);
      change = std::max(change, std::abs(value - static_cast<double>(grid[index])));
      grid[index] = static_cast<float>(value);
    }
    if (change < options.settled) break;
  }
  const auto greedy = [&](const typename P::State& state) { return typename P::Action(actions[best(state).first]); };
  return {evaluated(problem, greedy), "value iteration, " + std::to_string(grid.size()) + " grid points"};
}

}  // namespace classic
