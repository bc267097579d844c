// Where ball and kick target are: a Kalman filter of the sightings, with dead reckoning by the motion model of the walk
// between them.
// Thrun, Burgard, Fox: "Probabilistic Robotics", 2005, chapter 3; the state is the ball in the frame of the robot.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "ball.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/vec.hpp"

namespace sigmaban {

/// Standard deviations of one sighting.
struct SightingNoise {
  double position_m = 0.02;     // of the ball, in each direction [m]
  double per_distance = 0.04;   // and so much more with its distance [m/m]
  double direction_rad = 0.08;  // of the kick target [rad]

  double position(double distance) const { return position_m + per_distance * distance; }
};

struct BallFilterCriteria {
  SightingNoise sighting;
  double least_walk_m = 0.005;   // per cycle: no walk is known better than that [m]
  double least_walk_rad = 0.02;  // [rad]
  double outlier = 16.27;        // squared distance in standard deviations that one right sighting in 1000 exceeds
  int outliers_in_a_row = 3;     // then the ball is elsewhere, or the robot was turned: the last of them is believed
  double unknown_m = 0.25;       // half of the width that counts as under the robot: beyond, nobody knows the place [m]
};

class BallFilter {
 public:
  explicit BallFilter(const BallFilterCriteria& criteria = {}) : criteria_(criteria) {}

  /// The robot has turned by move.angle and then gone (move.x, move.y) in the frame it turned into, with these standard
  /// deviations [m, m, rad].
  void walked(const surefoot::Pose2& move, const surefoot::Vec<3>& deviation) {
    if (!ball_) return;
    const double c = std::cos(move.angle), s = std::sin(move.angle);
    const double x = c * ball_->x + s * ball_->y, y = c * ball_->y - s * ball_->x;  // after the turn
    ball_ = BallView{x - move.x, y - move.y, surefoot::wrap_angle(ball_->angle - move.angle)};
    Matrix turn, by_move;
    turn << c, s, 0, -s, c, 0, 0, 0, 1;
    by_move << -1, 0, y, 0, -1, -x, 0, 0, -1;
    const surefoot::Vec<3> least(criteria_.least_walk_m, criteria_.least_walk_m, criteria_.least_walk_rad);
    const surefoot::Vec<3> variance = deviation.cwiseMax(least).cwiseAbs2();
    covariance_ =
        (turn * covariance_ * turn.transpose() + by_move * variance.asDiagonal() * by_move.transpose()).eval();
  }

  void sighted(const BallView& seen) {
    const double place = criteria_.sighting.position(std::hypot(seen.x, seen.y));
    const Matrix noise =
        surefoot::Vec<3>(place, place, criteria_.sighting.direction_rad).cwiseAbs2().asDiagonal().toDenseMatrix();
    if (!ball()) return restart(seen, noise);
    const surefoot::Vec<3> off(seen.x - ball_->x, seen.y - ball_->y, surefoot::wrap_angle(seen.angle - ball_->angle));
    const Matrix certain = (covariance_ + noise).inverse();
    if (off.dot(certain * off) > criteria_.outlier) {
      if (++outliers_ >= criteria_.outliers_in_a_row) restart(seen, noise);
      return;
    }
    outliers_ = 0;
    const Matrix gain = covariance_ * certain;
    const surefoot::Vec<3> change = gain * off;
    ball_ = BallView{ball_->x + change[0], ball_->y + change[1], surefoot::wrap_angle(ball_->angle + change[2])};
    covariance_ = ((Matrix::Identity() - gain) * covariance_).eval();
    covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  }

  /// None before the first sighting, and where it is known too badly.
  std::optional<BallView> ball() const { return deviation() < criteria_.unknown_m ? ball_ : std::nullopt; }

  /// Of the position, in the direction in which it is known worst [m].
  double deviation() const {
    const double mean = 0.5 * (covariance_(0, 0) + covariance_(1, 1));
    const double half = 0.5 * (covariance_(0, 0) - covariance_(1, 1));
    return std::sqrt(mean + std::hypot(half, covariance_(0, 1)));
  }

 private:
  using Matrix = Eigen::Matrix3d;

  void restart(const BallView& seen, const Matrix& noise) {
    ball_ = seen;
    covariance_ = noise;
    outliers_ = 0;
  }

  BallFilterCriteria criteria_;
  std::optional<BallView> ball_;
  Matrix covariance_ = Matrix::Zero();
  int outliers_ = 0;  // in a row
};

}  // namespace sigmaban
