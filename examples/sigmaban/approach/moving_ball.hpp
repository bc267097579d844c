// The ball approach with a rolling ball: two more state dimensions, as the conclusion of the paper asks for.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "approach.hpp"
#include "surefoot/core/box.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"

namespace sigmaban {

/// State: that of Approach, then the velocity of the ball along x and y of the robot frame [m/cycle].
/// The ball rolls straight, slows down by the same amount every cycle, and the robot's feet do not touch it.
struct MovingBall {
  static constexpr int state_dim = 8, action_dim = 3;
  static constexpr int horizon = Approach::horizon;  // [walk cycles]
  using State = surefoot::Vec<state_dim>;
  using Action = surefoot::Vec<action_dim>;

  Approach robot = far_sighted();
  double max_start_speed = 0.08;  // of the ball, in any direction [m/cycle]
  double friction = 0.01;         // loss of speed [m/cycle^2]
  double noise = 0.005;           // half width, uniform, on each component while it rolls [m/cycle]

  surefoot::Box<state_dim> state_box() const {
    const surefoot::Box<Approach::state_dim> still = robot.state_box();
    State low, high;
    low << still.low(), -max_start_speed, -max_start_speed;
    high << still.high(), max_start_speed, max_start_speed;
    return {low, high};
  }

  surefoot::Box<action_dim> action_box() const { return robot.action_box(); }

  State initial_state(surefoot::Rng& rng) const {
    constexpr double pi = std::numbers::pi;
    State state;
    state.head<6>() = robot.initial_state(rng);
    const double speed = rng.uniform(0, max_start_speed);
    const double heading = rng.uniform(-pi, pi);
    state[6] = speed * std::cos(heading);
    state[7] = speed * std::sin(heading);
    return state;
  }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng& rng) const {
    const surefoot::Vec<3> speed = robot.speed_after(state.segment<3>(3), action);
    const surefoot::Pose2 move = robot.walk_cycle(speed, state.segment<3>(3), rng);

    // The ball rolls in the old robot frame; it may stop in mid-cycle.
    surefoot::Vec<2> ball{state[0] * std::cos(state[1]), state[0] * std::sin(state[1])};
    surefoot::Vec<2> velocity = state.tail<2>();
    const surefoot::Vec<2> push{rng.uniform(-noise, noise), rng.uniform(-noise, noise)};
    const double before = velocity.norm();
    if (before > 0) {
      const double after = std::max(0.0, before - friction);
      const double rolling_time = (before - after) / friction;  // [cycles], 1 unless it stops
      ball += velocity * (rolling_time * 0.5 * (before + after) / before);
      velocity *= after / before;
      if (after > 0) velocity = limited(velocity + push);
    }

    const surefoot::Pose2 turn{0, 0, -move.angle};
    const surefoot::Vec<2> seen = turn.transform(ball) - move.position();
    const auto arrival = robot.arrive(seen[0], seen[1], surefoot::wrap_angle(state[2] - move.angle), speed);
    surefoot::Step<State> result{.next = {}, .reward = arrival.reward, .terminal = arrival.terminal};
    result.next << arrival.next, turn.transform(velocity);
    return result;
  }

  /// Those of Approach, the velocity of the ball, and the place where it will stop.
  static constexpr int feature_dim = Approach::feature_dim + 4;
  surefoot::Vec<feature_dim> features(const State& s) const {
    const surefoot::Vec<2> velocity = s.tail<2>();
    const surefoot::Vec<2> ball{s[0] * std::cos(s[1]), s[0] * std::sin(s[1])};
    surefoot::Vec<feature_dim> f;
    f << robot.features(s.head<6>()), velocity, ball + velocity * (velocity.norm() / (2 * friction));
    return f;
  }

  std::vector<std::string> state_names() const {
    std::vector<std::string> names = robot.state_names();
    names.insert(names.end(), {"ball speed forward [m/cycle]", "ball speed left [m/cycle]"});
    return names;
  }

 private:
  // A ball that rolls away leaves the ring where a still one is lost; this robot sees further.
  static Approach far_sighted() {
    Approach robot = Approach::ha();
    robot.constants.max_distance = 1.5;
    return robot;
  }

  // Noise never makes the ball faster than any ball at the start.
  surefoot::Vec<2> limited(const surefoot::Vec<2>& velocity) const {
    const double speed = velocity.norm();
    return speed > max_start_speed ? surefoot::Vec<2>(velocity * (max_start_speed / speed)) : velocity;
  }
};

static_assert(surefoot::Problem<MovingBall>);
static_assert(surefoot::HasFeatures<MovingBall>);

}  // namespace sigmaban
