// Speeds, accelerations and noise of recorded angles.
#include "apps/diagnose/robot/motion.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "apps/diagnose/robot/torque_residual.hpp"
#include "surefoot/core/rng.hpp"

using namespace diagnose_robot;

namespace {

constexpr double period = 0.01;  // [s]

// A body of inertia 1 that a torque swings at 5 Hz, sampled at 100 Hz.
RobotRecording swinging(double noise = 0) {
  constexpr Eigen::Index rows = 800;
  constexpr double frequency = 2 * std::numbers::pi * 5, size = 0.2;
  RobotRecording recording;
  recording.time = Eigen::VectorXd::LinSpaced(rows, 0, period * (rows - 1));
  recording.torque = -size * frequency * frequency * (frequency * recording.time.array()).sin().matrix();
  recording.angle = size * (frequency * recording.time.array()).sin().matrix();
  surefoot::Rng rng(4);
  for (double& reading : recording.angle.reshaped()) reading += noise * rng.normal();
  return recording;
}

}  // namespace

TEST_CASE("behind the smoothing filter a torque and the acceleration that it causes are the same") {
  const Motion motion = smooth(swinging());
  const Eigen::Index rows = motion.a.rows() - 2 * motion.edge;
  const Eigen::VectorXd torque = motion.torque.col(0).segment(motion.edge, rows),
                        acceleration = motion.a.col(0).segment(motion.edge, rows);
  CHECK(acceleration.dot(torque) / torque.squaredNorm() == doctest::Approx(1).epsilon(0.02));
}

TEST_CASE("the noise of a coarse encoder is that of its steps") {
  surefoot::Rng rng(7);
  for (const double share : {0.13, 0.2, 0.3, 0.5}) {  // of a step, of noise before it is rounded
    constexpr double step = 1.5e-3;
    Eigen::VectorXd readings(2000);
    for (Eigen::Index k = 0; k < readings.size(); ++k) {
      const double t = period * static_cast<double>(k);
      readings[k] = step * std::round((0.5 * std::sin(2 * t) + 0.3 * std::sin(5 * t)) / step + share * rng.normal());
    }
    CHECK(noise_of(readings) == doctest::Approx(step * std::hypot(share, 1 / std::sqrt(12.0))).epsilon(0.1));
  }
}

TEST_CASE("jumps of a motion are no noise of its sensor") {
  surefoot::Rng rng(5);
  Eigen::VectorXd readings(2000);
  for (Eigen::Index k = 0; k < readings.size(); ++k)
    readings[k] = 0.3 * static_cast<double>(k / 100) + 1e-3 * rng.normal();
  CHECK(noise_of(readings) == doctest::Approx(1e-3).epsilon(0.15));
}

TEST_CASE("a joint that moves by no more than its noise stands") {
  RobotRecording recording = swinging(1e-3);
  surefoot::Rng rng(6);
  for (double& reading : recording.angle.reshaped()) reading = 1e-3 * rng.normal();
  const Motion motion = smooth(recording);
  const double rest = resting_speed(motion)[0];
  CHECK((motion.v.col(0).cwiseAbs().array() < rest).count() > 0.98 * static_cast<double>(motion.v.rows()));
}
