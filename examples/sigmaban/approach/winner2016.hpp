// Winner2016: the hand-tuned approach that won RoboCup 2016, a policy with three modes and 15 parameters.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "approach.hpp"
#include "surefoot/core/box.hpp"
#include "surefoot/core/policy.hpp"
#include "surefoot/core/vec.hpp"

namespace sigmaban {

/// The parameters, by name. Their order as a vector is the order here.
struct Winner2016Parameters {
  double max_rotate_radius = 1.0;         // [m]
  double min_far_radius = 0.75;           // [m]
  double radius = 0.5;                    // [m]
  double step_p = 0.1;                    // [1/step]
  double far_theta_p = 0.2;               // [1/step]
  double rotate_theta_p = 0.3;            // [1/step]
  double rotate_lateral_p = -0.2;         // [m/(rad step)]
  double near_theta_p = 0.1;              // [1/step]
  double near_lateral_p = 0.06;           // [1/step]
  double stop_y_near = 0.125;             // [m]
  double max_y_near = 0.25;               // [m]
  double wished_x = 0.22;                 // [m]
  double wished_y = 0.0;                  // [m]
  double target_theta_tol = 10 * degree;  // [rad]
  double ball_theta_tol = 10 * degree;    // [rad]

  static constexpr int count = 15;
  using Vector = surefoot::Vec<count>;

  /// What the robot walked with at RoboCup 2016.
  static Winner2016Parameters winner2016() { return {}; }

  /// What the authors' own CMA-ES run left in the public history of their experiments.
  static Winner2016Parameters tuned() {
    return {0.99, 0.72, 0.198, 0.21, 0.26, 0.47, -0.044, 0.21, 0.178, 0.10, 0.35, 0.21, 0.0, 0.072, 0.29};
  }

  Vector vec() const;
  static Winner2016Parameters from_vec(const Vector& values);
};

/// Name, unit and tuning range of one parameter.
struct Winner2016Parameter {
  std::string_view name, unit;
  double low, high;
  double Winner2016Parameters::* member;
};

inline constexpr std::array<Winner2016Parameter, Winner2016Parameters::count> winner2016_parameters{{
    {"max_rotate_radius", "m", 0.2, 1.2, &Winner2016Parameters::max_rotate_radius},
    {"min_far_radius", "m", 0.1, 1.0, &Winner2016Parameters::min_far_radius},
    {"radius", "m", 0.1, 0.8, &Winner2016Parameters::radius},
    {"step_p", "1/step", 0.0, 1.0, &Winner2016Parameters::step_p},
    {"far_theta_p", "1/step", 0.0, 1.0, &Winner2016Parameters::far_theta_p},
    {"rotate_theta_p", "1/step", 0.0, 1.0, &Winner2016Parameters::rotate_theta_p},
    {"rotate_lateral_p", "m/(rad step)", -0.4, 0.0, &Winner2016Parameters::rotate_lateral_p},
    {"near_theta_p", "1/step", 0.0, 1.0, &Winner2016Parameters::near_theta_p},
    {"near_lateral_p", "1/step", 0.0, 1.0, &Winner2016Parameters::near_lateral_p},
    {"stop_y_near", "m", 0.0, 0.4, &Winner2016Parameters::stop_y_near},
    {"max_y_near", "m", 0.0, 0.6, &Winner2016Parameters::max_y_near},
    {"wished_x", "m", 0.15, 0.3, &Winner2016Parameters::wished_x},
    {"wished_y", "m", -0.05, 0.05, &Winner2016Parameters::wished_y},
    {"target_theta_tol", "rad", 0.0, 1.0, &Winner2016Parameters::target_theta_tol},
    {"ball_theta_tol", "rad", 0.0, 1.0, &Winner2016Parameters::ball_theta_tol},
}};

inline Winner2016Parameters::Vector Winner2016Parameters::vec() const {
  Vector values;
  for (int i = 0; i < count; ++i) values[i] = this->*winner2016_parameters[static_cast<std::size_t>(i)].member;
  return values;
}

inline Winner2016Parameters Winner2016Parameters::from_vec(const Vector& values) {
  Winner2016Parameters parameters;
  for (int i = 0; i < count; ++i) parameters.*winner2016_parameters[static_cast<std::size_t>(i)].member = values[i];
  return parameters;
}

/// The tuning ranges as a box.
inline surefoot::Box<Winner2016Parameters::count> winner2016_box() {
  Winner2016Parameters::Vector low, high;
  for (int i = 0; i < Winner2016Parameters::count; ++i) {
    low[i] = winner2016_parameters[static_cast<std::size_t>(i)].low;
    high[i] = winner2016_parameters[static_cast<std::size_t>(i)].high;
  }
  return {low, high};
}

/// Walks to the ball (Far), turns around it (Rotate), then lines up (Near). Asks for a speed by asking for the
/// difference to the current one.
class Winner2016 {
 public:
  enum class Mode { Far, Rotate, Near };

  Winner2016() = default;
  explicit Winner2016(const Winner2016Parameters& parameters) : p_(parameters) {}

  void reset() { mode_ = Mode::Far; }
  Mode mode() const { return mode_; }
  const Winner2016Parameters& parameters() const { return p_; }

  Approach::Action operator()(const Approach::State& state) {
    const double d = state[0], b = state[1], k = state[2];
    const double x = d * std::cos(b), y = d * std::sin(b);
    change_mode(d, b, k, y);
    surefoot::Vec<3> wished = surefoot::Vec<3>::Zero();
    switch (mode_) {
      case Mode::Far:
        wished[0] = std::max(0.0, far_speed * std::cos(b));
        wished[2] = p_.far_theta_p * b;
        break;
      case Mode::Rotate:
        wished[0] = p_.step_p * (d - p_.radius);
        wished[1] = p_.rotate_lateral_p * k;
        wished[2] = p_.rotate_theta_p * b;
        break;
      case Mode::Near:
        if (std::abs(y - p_.wished_y) < p_.stop_y_near) wished[0] = p_.step_p * (x - p_.wished_x);
        wished[1] = p_.near_lateral_p * (y - p_.wished_y);
        if (std::abs(k) >= p_.target_theta_tol) wished[2] = p_.near_theta_p * k;
        break;
    }
    return wished - state.tail<3>();
  }

 private:
  static constexpr double far_speed = 0.04;  // [m/step]

  // The tests follow each other: one call may pass through several modes.
  void change_mode(double d, double b, double k, double y) {
    if (mode_ == Mode::Far && d < p_.min_far_radius) mode_ = Mode::Rotate;
    if (d > p_.max_rotate_radius) mode_ = Mode::Far;
    if (mode_ == Mode::Rotate && std::abs(k) < p_.target_theta_tol && std::abs(b) < p_.ball_theta_tol) {
      mode_ = Mode::Near;
    }
    if (mode_ == Mode::Near && y > p_.max_y_near) mode_ = Mode::Rotate;
  }

  Winner2016Parameters p_;
  Mode mode_ = Mode::Far;
};

static_assert(surefoot::Policy<Winner2016, Approach>);

}  // namespace sigmaban
