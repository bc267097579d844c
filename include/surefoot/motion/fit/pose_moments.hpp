// Mean and covariance of a pose after displacements with noise. To first order a robot that is not sure of its heading
// still goes as far as it thinks; in truth the mean of where it may be falls short of that, by exp(-variance / 2), and
// the rest of the path spreads along the track as well. Both moments are exact here, for normal noise of the heading.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>

#include "surefoot/core/pose2.hpp"
#include "surefoot/core/vec.hpp"

namespace surefoot::detail {

/// How much shorter the mean of a displacement becomes by a heading of that variance [rad^2].
inline double shortening(double heading_variance) { return std::exp(-0.5 * heading_variance); }

/// Covariance of a pose, and what is needed to carry it on: moments of z = x + i y and of the direction e^(i heading).
class PoseMoments {
 public:
  /// The pose is known.
  PoseMoments() = default;

  /// Of a pose with this heading, jointly normal with that covariance.
  PoseMoments(const Eigen::Matrix3d& covariance, double heading)
      : heading_(covariance(2, 2)),
        square_(covariance(0, 0) + covariance(1, 1)),
        product_(covariance(0, 0) - covariance(1, 1), 2 * covariance(0, 1)),
        with_heading_(covariance(0, 2), covariance(1, 2)) {
    const Complex direction = std::polar(shortening(heading_), heading);
    against_ = -i * with_heading_ * std::conj(direction);
    along_ = i * with_heading_ * direction;
  }

  /// Moves the mean `pose`, and this, by a displacement whose components are independent with that variance.
  void move(Vec<3>& pose, const Pose2& displacement, const Vec<3>& variance) {
    const Complex d(displacement.x, displacement.y), direction = std::polar(1.0, pose[2]);
    const double shrink = shortening(heading_), lost = -std::expm1(-heading_);
    const Complex mean = shrink * direction;                               // of e^(i heading)
    const Complex bent = -lost * shrink * shrink * direction * direction;  // E e^(2 i heading) - mean^2
    square_ += 2 * (std::conj(against_) * d).real() + lost * std::norm(d) + variance[0] + variance[1];
    product_ +=
        2.0 * along_ * d + bent * d * d + std::exp(-2 * heading_) * direction * direction * (variance[0] - variance[1]);
    const Complex turn = std::polar(shortening(variance[2]), displacement.angle);
    against_ = (against_ + lost * d) * std::conj(turn);
    along_ = (along_ + bent * d) * turn;
    with_heading_ += i * heading_ * mean * d;
    heading_ += variance[2];
    const Complex step = mean * d;
    pose += Vec<3>{step.real(), step.imag(), displacement.angle};
  }

  Eigen::Matrix3d covariance() const {
    const double x = (square_ + product_.real()) / 2, y = (square_ - product_.real()) / 2, xy = product_.imag() / 2;
    const double xh = with_heading_.real(), yh = with_heading_.imag();
    return Eigen::Matrix3d{{x, xy, xh}, {xy, y, yh}, {xh, yh, heading_}};
  }

 private:
  using Complex = std::complex<double>;
  static constexpr Complex i{0, 1};

  double heading_ = 0;               // variance [rad^2]
  double square_ = 0;                // E |z - Ez|^2 [m^2]
  Complex product_ = 0;              // E (z - Ez)^2 [m^2]
  Complex with_heading_ = 0;         // E (z - Ez) heading [m rad]
  Complex against_ = 0, along_ = 0;  // E (z - Ez) e^(-i heading), E (z - Ez) e^(i heading) [m]
};

}  // namespace surefoot::detail
