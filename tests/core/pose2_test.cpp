#include "surefoot/core/pose2.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "surefoot/core/box.hpp"
#include "surefoot/core/rng.hpp"

using surefoot::Pose2;
using surefoot::Vec;
using surefoot::wrap_angle;

namespace {

constexpr double pi = std::numbers::pi;

Pose2 random_pose(surefoot::Rng& rng) { return {rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-pi, pi)}; }

void check_near(const Pose2& a, const Pose2& b) {
  CHECK((a.position() - b.position()).norm() < 1e-12);
  CHECK(std::abs(wrap_angle(a.angle - b.angle)) < 1e-12);
}

}  // namespace

TEST_CASE("wrap_angle keeps the direction and lands in [-pi, pi)") {
  CHECK(wrap_angle(0.3) == 0.3);
  CHECK(wrap_angle(pi) == -pi);
  CHECK(wrap_angle(-pi) == -pi);
  CHECK(wrap_angle(7 * pi) == doctest::Approx(-pi));
  CHECK(std::isnan(wrap_angle(std::nan(""))));
  surefoot::Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const double angle = rng.uniform(-100, 100);
    const double wrapped = wrap_angle(angle);
    CHECK(wrapped >= -pi);
    CHECK(wrapped < pi);
    CHECK(std::abs(std::sin(0.5 * (wrapped - angle))) < 1e-13);
  }
}

TEST_CASE("wrap_angle stays in [-pi, pi) one rounding away from each end") {
  for (const double end : {-3 * pi, -pi, pi, 3 * pi}) {
    for (const double to : {-10.0, 10.0}) {
      const double wrapped = wrap_angle(std::nextafter(end, to));
      CHECK(wrapped >= -pi);
      CHECK(wrapped < pi);
    }
  }
}

TEST_CASE("a quarter turn to the left looks along y") {
  const Pose2 pose{1, 2, pi / 2};
  const Vec<2> point = pose.transform({3, 0});
  CHECK(point[0] == doctest::Approx(1));
  CHECK(point[1] == doctest::Approx(5));
}

TEST_CASE("compose is associative, acts like transform after transform, and inverse undoes it") {
  surefoot::Rng rng(2);
  for (int i = 0; i < 100; ++i) {
    const Pose2 a = random_pose(rng), b = random_pose(rng), c = random_pose(rng);
    const Vec<2> point = surefoot::Box<2>::symmetric({1, 1}).sample(rng);
    check_near((a * b) * c, a * (b * c));
    check_near(a * a.inverse(), {});
    check_near(a.inverse() * a, {});
    CHECK(((a * b).transform(point) - a.transform(b.transform(point))).norm() < 1e-12);
  }
}

TEST_CASE("log and exp undo each other, small turns included") {
  surefoot::Rng rng(3);
  for (const double scale : {1e-12, 1e-6, 0.99e-4, 1.01e-4, 1e-2, 1.0}) {
    for (int i = 0; i < 50; ++i) {
      Pose2 pose = random_pose(rng);
      pose.angle *= scale;
      check_near(Pose2::exp(pose.log()), pose);
    }
  }
}

TEST_CASE("exp is many small steps of the same velocity") {
  const Vec<3> velocity{0.5, -0.2, 2.5};
  constexpr int steps = 100'000;
  Pose2 pose;
  const Pose2 small = Pose2::from_vec(velocity / steps);
  for (int i = 0; i < steps; ++i) pose = pose * small;
  const Pose2 whole = Pose2::exp(velocity);
  CHECK((pose.position() - whole.position()).norm() < 1e-4);  // first order in 1 / steps
  CHECK(pose.angle == doctest::Approx(whole.angle));
}
