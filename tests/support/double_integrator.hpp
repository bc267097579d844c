// A mass on a line, pushed to the origin: linear dynamics and quadratic cost, so the optimum is known exactly.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "surefoot/core/policy.hpp"
#include "surefoot/core/problem.hpp"

namespace surefoot::toy {

/// State: position [m] and speed [m/s]; action: acceleration [m/s^2]. Starts at rest, position uniform in [-1, 1].
/// Reward -(position^2 + acceleration^2) * time_step, on the state that is left.
struct DoubleIntegrator {
  static constexpr int state_dim = 2, action_dim = 1;
  using State = Vec<2>;
  using Action = Vec<1>;

  double time_step = 0.1;  // [s]
  double push = 0;         // [m/s], standard deviation of the speed's noise per transition

  Box<2> state_box() const { return Box<2>::symmetric(State(1.5, 1.5)); }
  Box<1> action_box() const { return Box<1>::symmetric(Action(1.5)); }
  State initial_state(Rng& rng) const { return State(rng.uniform(-1, 1), 0); }
  Step<State> step(const State& state, const Action& action, Rng& rng) const {
    const double a = action_box().clamp(action)[0];
    const double noise = push > 0 ? push * rng.normal() : 0.0;
    return {State(state[0] + state[1] * time_step, state[1] + a * time_step + noise),
            -(state[0] * state[0] + a * a) * time_step, false};
  }
};

/// The optimum over `horizon` transitions by the Riccati recursion: linear feedback that knows the time left. Exact
/// where the action stays inside its box, which it does from the problem's own starts without noise.
class DoubleIntegratorOptimum {
 public:
  DoubleIntegratorOptimum(const DoubleIntegrator& problem, int horizon) {
    const double dt = problem.time_step;
    const Eigen::Matrix2d a{{1, dt}, {0, 1}};
    const Eigen::Vector2d b(0, dt);
    const Eigen::Matrix2d stage = Eigen::Vector2d(dt, 0).asDiagonal();
    for (int t = 0; t < horizon; ++t) {
      noise_cost_ += problem.push * problem.push * cost_(1, 1);
      const Eigen::RowVector2d gain = b.transpose() * cost_ * a / (dt + b.dot(cost_ * b));
      const Eigen::Matrix2d closed = a - b * gain;
      cost_ = (stage + dt * gain.transpose() * gain + closed.transpose() * cost_ * closed).eval();
      gains_.push_back(gain);
    }
    reset();
  }

  void reset() { left_ = gains_.size(); }
  Vec<1> operator()(const Vec<2>& state) {
    left_ = std::max<std::size_t>(left_, 1) - 1;
    return -gains_[left_] * state;
  }

  double expected_return(const Vec<2>& start) const { return -start.dot(cost_ * start) - noise_cost_; }
  double expected_return() const { return -cost_(0, 0) / 3 - noise_cost_; }  // from the problem's own starts

 private:
  std::vector<Eigen::RowVector2d> gains_;  // gains_[i] with i transitions to come after this one
  Eigen::Matrix2d cost_ = Eigen::Matrix2d::Zero();
  double noise_cost_ = 0;
  std::size_t left_ = 0;
};

static_assert(Problem<DoubleIntegrator> && Policy<DoubleIntegratorOptimum, DoubleIntegrator>);

}  // namespace surefoot::toy
