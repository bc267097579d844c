// The ball approach of the humanoid robot Sigmaban as a CSA-MDP, and its almost non-holonomic variant.
// Hofer and Rouxel, "An Operational Method Toward Efficient Walk Control Policies for Humanoid Robots", ICAPS 2017.
//
// Robot frame: x forward, y left. Ball at (d cos b, d sin b), kick target in direction k.
#pragma once

#include <cmath>
#include <concepts>
#include <numbers>
#include <string>
#include <vector>

#include "surefoot/core/box.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/noise.hpp"

namespace sigmaban {

inline constexpr double degree = std::numbers::pi / 180.0;  // [rad]

/// Displacement of a walk cycle = A (1, orders of the cycle): calibrated on the real robot [m, m, rad].
inline surefoot::FullLinearCorrection sigmaban_walk() {
  return surefoot::FullLinearCorrection::from_parameters(surefoot::Vec<12>{0.0093, 1.30, -0.17, 0.001,    // forward
                                                                           -0.0026, -0.075, 1.47, 0.101,  // left
                                                                           0.0002, -0.35, 0.05, 0.909});  // turn
}

/// The noise of a walk cycle, as published [m, m, rad].
inline surefoot::UniformNoise sigmaban_noise() { return {{0.02, 0.02, 5 * degree}}; }

/// Every other figure of the problem. Speeds and accelerations are ordered (forward, left, turn).
struct ApproachConstants {
  surefoot::Vec<3> min_speed{-0.02, -0.02, -0.2};       // commanded [m/step, m/step, rad/step]
  surefoot::Vec<3> max_speed{0.04, 0.02, 0.2};          // commanded [m/step, m/step, rad/step]
  surefoot::Vec<3> max_acceleration{0.02, 0.01, 0.15};  // per walk cycle, either sign [m/step, m/step, rad/step]
  double steps_per_cycle = 2;                           // one transition is one walk cycle
  bool turn_first = true;  // a displacement is seen from the robot as it has turned: published so; calibrated: before

  double kick_min_x = 0.15, kick_max_x = 0.30, kick_max_y = 0.06;                  // ball in the kick zone [m]
  double kick_tolerance = 10 * degree;                                             // of the kick direction [rad]
  double collision_min_x = -0.20, collision_max_x = 0.15, collision_max_y = 0.25;  // ball under the robot [m]
  double max_distance = 1.0;                                                       // beyond, the ball is lost [m]
  double step_reward = -1, collision_reward = -3, lost_reward = -100;

  double start_min_distance = 0.4, start_max_distance = 0.95;  // [m]
};

/// State: ball distance d [m], ball direction b [rad], kick direction k [rad], commanded speed vx, vy [m/step],
/// vt [rad/step]. Action: change of the commanded speed. A run is `horizon` transitions, or ends when the ball is
/// lost; standing in the kick zone costs nothing and does not end it. Cost = -(sum of rewards), no discount. Walk and
/// noise are those of the published robot, or whatever was calibrated on another.
template <surefoot::MotionModel Walk = surefoot::FullLinearCorrection,
          surefoot::NoiseModel Noise = surefoot::UniformNoise>
struct ApproachWith {
  static constexpr int state_dim = 6, action_dim = 3;
  static constexpr int horizon = 50;  // [walk cycles]
  using State = surefoot::Vec<state_dim>;
  using Action = surefoot::Vec<action_dim>;

  ApproachConstants constants;
  Walk walk = published<Walk>();
  Noise noise = published<Noise>();

  /// Holonomic approach: the robot as it is.
  static ApproachWith ha() { return {}; }

  /// Almost non-holonomic approach: lateral steps are five times weaker, published lateral noise is half.
  static ApproachWith anha() {
    ApproachWith problem;
    ApproachConstants& c = problem.constants;
    c.min_speed[1] /= 5;
    c.max_speed[1] /= 5;
    c.max_acceleration[1] /= 5;
    if constexpr (std::same_as<Noise, surefoot::UniformNoise>) problem.noise.half_width[1] /= 2;
    return problem;
  }

  surefoot::Box<state_dim> state_box() const {
    constexpr double pi = std::numbers::pi;
    State low, high;
    low << 0, -pi, -pi, constants.min_speed;
    high << constants.max_distance, pi, pi, constants.max_speed;
    return {low, high};
  }

  surefoot::Box<action_dim> action_box() const {
    return surefoot::Box<action_dim>::symmetric(constants.max_acceleration);
  }

  State initial_state(surefoot::Rng& rng) const {
    constexpr double pi = std::numbers::pi;
    State state = State::Zero();
    state[0] = rng.uniform(constants.start_min_distance, constants.start_max_distance);
    state[1] = rng.uniform(-pi, pi);
    state[2] = rng.uniform(-pi, pi);
    return state;
  }

  surefoot::Step<State> step(const State& state, const Action& action, surefoot::Rng& rng) const {
    const surefoot::Vec<3> speed = speed_after(state.template tail<3>(), action);
    const surefoot::Pose2 move = walk_cycle(speed, state.template tail<3>(), rng);
    // The robot turns, then walks.
    const double direction = state[1] - move.angle;
    return arrive(state[0] * std::cos(direction) - move.x, state[0] * std::sin(direction) - move.y,
                  surefoot::wrap_angle(state[2] - move.angle), speed);
  }

  /// The commanded speed after an action, both kept within their bounds.
  surefoot::Vec<3> speed_after(const surefoot::Vec<3>& speed, const Action& action) const {
    const Action change = action.cwiseMax(-constants.max_acceleration).cwiseMin(constants.max_acceleration);
    return (speed + change).cwiseMax(constants.min_speed).cwiseMin(constants.max_speed);
  }

  /// What the robot really does in one walk cycle with that commanded speed, after one with the speed `before`: seen
  /// from the robot as it has turned.
  surefoot::Pose2 walk_cycle(const surefoot::Vec<3>& speed, const surefoot::Vec<3>& before, surefoot::Rng& rng) const {
    const surefoot::Vec<3> orders = constants.steps_per_cycle * speed, previous = constants.steps_per_cycle * before;
    const surefoot::Vec<3> noise_here = noise.sample(orders, previous, rng);
    return seen_after_turn(surefoot::Pose2::from_vec(cycle_displacement(walk, orders, previous).vec() + noise_here));
  }

  /// The same without its noise.
  surefoot::Pose2 expected_walk_cycle(const surefoot::Vec<3>& speed, const surefoot::Vec<3>& before) const {
    const double steps = constants.steps_per_cycle;
    return seen_after_turn(cycle_displacement(walk, surefoot::Vec<3>(steps * speed), surefoot::Vec<3>(steps * before)));
  }

  /// Standard deviations of its noise [m, m, rad].
  surefoot::Vec<3> walk_deviation(const surefoot::Vec<3>& speed, const surefoot::Vec<3>& before) const {
    const surefoot::Vec<3> orders = constants.steps_per_cycle * speed, previous = constants.steps_per_cycle * before;
    if constexpr (requires { noise.as_motion_noise(); }) {
      return noise.as_motion_noise().deviation(orders, previous);
    } else {
      return noise.deviation(orders, previous);
    }
  }

  /// The state, reward and end of arriving with the ball at (x, y) [m] and the kick target in direction `kick` [rad].
  surefoot::Step<State> arrive(double x, double y, double kick, const surefoot::Vec<3>& speed) const {
    const ApproachConstants& c = constants;
    const double distance = std::sqrt(x * x + y * y);
    surefoot::Step<State> result;
    result.next << distance, surefoot::wrap_angle(std::atan2(y, x)), kick, speed;
    if (can_kick(x, y, kick)) {
      result.reward = 0;
    } else if (x > c.collision_min_x && x < c.collision_max_x && std::abs(y) < c.collision_max_y) {
      result.reward = c.collision_reward;
    } else if (distance > c.max_distance) {
      result.reward = c.lost_reward;
      result.terminal = true;
    } else {
      result.reward = c.step_reward;
    }
    return result;
  }

  /// Whether the robot may kick there.
  bool can_kick(double x, double y, double kick) const {
    const ApproachConstants& c = constants;
    return x > c.kick_min_x && x < c.kick_max_x && std::abs(y) < c.kick_max_y && std::abs(kick) < c.kick_tolerance;
  }

  /// For regression: where ball and kick target will be, seen from the robot, after one walk cycle at the present speed
  /// and without noise (Cartesian, polar, and in the frame that looks in the kick direction), the ball's distance and
  /// its direction from the kick line now, and the speed. `export` writes the same lines in C.
  static constexpr int feature_dim = 11;
  surefoot::Vec<feature_dim> features(const State& s) const {
    const surefoot::Vec<3> orders = constants.steps_per_cycle * s.template tail<3>();
    const surefoot::Pose2 move = seen_after_turn(cycle_displacement(walk, orders, orders));
    const double direction = s[1] - move.angle, kick = s[2] - move.angle;
    const double x = s[0] * std::cos(direction) - move.x, y = s[0] * std::sin(direction) - move.y;
    const double c = std::cos(kick), k = std::sin(kick);
    surefoot::Vec<feature_dim> f;
    f << x, y, std::atan2(y, x), kick, c * x + k * y, c * y - k * x, s[0], surefoot::wrap_angle(s[1] - s[2]),
        s.template tail<3>();
    return f;
  }

  std::vector<std::string> state_names() const {
    return {"ball distance [m]",      "ball direction [rad]",   "kick direction [rad]",
            "forward speed [m/step]", "lateral speed [m/step]", "turn speed [rad/step]"};
  }
  std::vector<std::string> action_names() const {
    return {"forward acceleration [m/step]", "lateral acceleration [m/step]", "turn acceleration [rad/step]"};
  }

 private:
  surefoot::Pose2 seen_after_turn(const surefoot::Pose2& move) const {
    if (constants.turn_first) return move;
    const double c = std::cos(move.angle), s = std::sin(move.angle);
    return {c * move.x + s * move.y, c * move.y - s * move.x, move.angle};
  }

  template <class T>
  static T published() {
    if constexpr (std::same_as<T, surefoot::FullLinearCorrection>) return sigmaban_walk();
    if constexpr (std::same_as<T, surefoot::UniformNoise>) return sigmaban_noise();
    return T();
  }
};

/// The problem as published.
using Approach = ApproachWith<>;

/// "ha" or "anha".
inline Approach problem_named(const std::string& name) { return name == "ha" ? Approach::ha() : Approach::anha(); }

static_assert(surefoot::Problem<Approach>);
static_assert(surefoot::HasFeatures<Approach>);

}  // namespace sigmaban
