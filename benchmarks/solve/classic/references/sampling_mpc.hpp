// Model predictive control by the cross-entropy method: plans anew in every step, far too slow for a robot, and a
// good reference where the dimensions are too many for a grid.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "reference.hpp"
#include "surefoot/core/box.hpp"

namespace classic {

struct MpcOptions {
  int horizon = 30;    // of the plan [transitions]
  int samples = 200;   // plans tried per round
  int rounds = 4;      // of narrowing down
  double elite = 0.1;  // share of the plans that the next round is drawn around
  double keep = 0.3;   // share of the last round's mean and width that stays
};

/// Plans from the state it is in, does the first action, goes on from the rest of the plan. Problems without noise.
template <surefoot::Problem P>
class SamplingMpc {
 public:
  using State = typename P::State;
  using Action = typename P::Action;

  SamplingMpc(const P& problem, const MpcOptions& options)
      : problem_(&problem), options_(options), box_(problem.action_box()) {
    reset(surefoot::Rng(0));
  }

  void reset(const surefoot::Rng& rng) {
    rng_ = rng;
    mean_.assign(static_cast<std::size_t>(options_.horizon), box_.center());
  }

  Action operator()(const State& state) {
    const auto length = mean_.size();
    std::vector<Action> width(length, Action(0.5 * box_.width()));
    std::vector<Action> best = mean_;
    double best_return = value(state, mean_);
    std::vector<std::vector<Action>> plans(static_cast<std::size_t>(options_.samples));
    std::vector<double> returns(plans.size());
    std::vector<std::size_t> order(plans.size());
    for (int round = 0; round < options_.rounds; ++round) {
      for (std::size_t i = 0; i < plans.size(); ++i) {
        plans[i] = draw(width);
        returns[i] = value(state, plans[i]);
        if (returns[i] > best_return) {
          best_return = returns[i];
          best = plans[i];
        }
      }
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return returns[a] > returns[b]; });
      order.resize(static_cast<std::size_t>(options_.elite * options_.samples));
      narrow(plans, order, width);
      order.resize(plans.size());
    }
    mean_ = best;
    const Action action = mean_.front();
    mean_.erase(mean_.begin());
    mean_.push_back(box_.center());
    return action;
  }

 private:
  /// A plan around the mean; its noise changes slowly, as good plans do.
  std::vector<Action> draw(const std::vector<Action>& width) {
    std::vector<Action> plan = mean_;
    Action noise = Action::Zero();
    const double smooth = 0.3 + 0.6 * rng_.uniform();
    for (std::size_t t = 0; t < plan.size(); ++t) {
      for (int i = 0; i < P::action_dim; ++i) {
        noise[i] = (t == 0 ? 0.0 : smooth * noise[i]) + (t == 0 ? 1.0 : std::sqrt(1 - smooth * smooth)) * rng_.normal();
      }
      plan[t] = box_.clamp(Action(plan[t] + noise.cwiseProduct(width[t])));
    }
    return plan;
  }

  double value(const State& start, const std::vector<Action>& plan) const {
    surefoot::Rng none(0);
    State state = start;
    double sum = 0;
    for (const Action& action : plan) {
      const auto step = problem_->step(state, action, none);
      sum += step.reward;
      if (step.terminal) break;
      state = step.next;
    }
    return sum;
  }

  void narrow(const std::vector<std::vector<Action>>& plans, const std::vector<std::size_t>& elite,
              std::vector<Action>& width) {
    const double share = 1.0 / static_cast<double>(elite.size());
    for (std::size_t t = 0; t < mean_.size(); ++t) {
      Action mean = Action::Zero(), squares = Action::Zero();
      for (const std::size_t i : elite) mean += share * plans[i][t];
      for (const std::size_t i : elite) squares += share * (plans[i][t] - mean).cwiseAbs2();
      mean_[t] = options_.keep * mean_[t] + (1 - options_.keep) * mean;
      width[t] = options_.keep * width[t] + (1 - options_.keep) * squares.cwiseSqrt();
    }
  }

  const P* problem_;
  MpcOptions options_;
  surefoot::Box<P::action_dim> box_;
  surefoot::Rng rng_{0};
  std::vector<Action> mean_;
};

template <surefoot::Problem P>
Reference mpc_reference(const P& problem, const MpcOptions& options) {
  return {evaluated(problem, SamplingMpc<P>(problem, options)),
          "cross-entropy MPC, " + std::to_string(options.samples * options.rounds) + " plans of " +
              std::to_string(options.horizon) + " steps for each action"};
}

}  // namespace classic
