#include "surefoot/motion/plan/command_plan.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/sigmaban_walk.hpp"

using surefoot::MotionError;
using surefoot::OrderBounds;
using surefoot::orders_within;
using surefoot::plan_orders;
using surefoot::Vec;

TEST_CASE("planned orders keep their bounds and use all of them") {
  const OrderBounds bounds;
  Vec<3> low = Vec<3>::Zero(), high = Vec<3>::Zero();
  for (const Eigen::Matrix3Xd& orders : plan_orders(bounds, 50, 25, 1)) {
    CHECK(orders.cols() == 25);
    CHECK_FALSE(orders_within(bounds, orders).has_value());
    low = low.cwiseMin(orders.rowwise().minCoeff());
    high = high.cwiseMax(orders.rowwise().maxCoeff());
  }
  CHECK(low == bounds.low);
  CHECK(high == bounds.high);
}

TEST_CASE("a longer plan begins with the shorter one, and another seed plans something else") {
  const auto few = plan_orders({}, 2, 10, 7), many = plan_orders({}, 4, 10, 7), other = plan_orders({}, 2, 10, 8);
  CHECK(few[1] == many[1]);
  CHECK(few[1] != few[0]);
  CHECK(few[1] != other[1]);
}

TEST_CASE("wrong bounds and counts are refused by name") {
  OrderBounds bounds;
  bounds.low[1] = 0.01;
  CHECK_THROWS_WITH_AS(check(bounds), "OrderBounds: low of dy must be a finite number up to 0, got 0.01", MotionError);
  bounds = {};
  bounds.high[0] = std::nan("");
  CHECK_THROWS_AS(check(bounds), MotionError);
  bounds = {};
  bounds.acceleration[2] = 0;
  CHECK_THROWS_WITH_AS(
      check(bounds), "OrderBounds: acceleration of turn must be above 0 for orders that may vary, got 0", MotionError);
  CHECK_THROWS_WITH_AS(plan_orders({}, 0, 25, 1), "plan_orders: sequences must be at least 1, got 0", MotionError);
  CHECK_THROWS_WITH_AS(plan_orders({}, 1, 0, 1), "plan_orders: cycles must be at least 1, got 0", MotionError);
}

TEST_CASE("orders from elsewhere are checked, and the first that breaks the bounds is named") {
  Eigen::Matrix3Xd orders = Eigen::Matrix3Xd::Zero(3, 3);
  orders.col(1) << 0.04, 0, 0;
  orders.col(2) << 0.09, 0, 0;
  CHECK(orders_within({}, orders).value() == "cycle 3: the order dx = 0.09 m lies outside [-0.04, 0.08]");
  orders.col(2) << 0.04, 0.03, 0;
  CHECK(orders_within({}, orders).value() ==
        "cycle 3: the order dy = 0.03 m differs by 0.03 from the one before, more than the 0.02 allowed");
  CHECK_FALSE(orders_within({}, orders.rightCols(1), {0.04, 0.02, 0}).has_value());
  orders(2, 0) = std::nan("");
  CHECK(orders_within({}, orders).value() == "cycle 1: the order turn = nan rad is no number");
}

TEST_CASE("the space needed holds 99 of 100 walks, and without noise exactly the path") {
  const std::vector<Eigen::Matrix3Xd> orders = plan_orders({}, 5, 25, 3);
  const surefoot::Box<2> room = surefoot::space_needed(sigmaban::model(), sigmaban::noise(), orders, 400, 1);
  int inside = 0;
  for (std::uint64_t run = 0; run < 400; ++run) {
    for (const Eigen::Matrix3Xd& one : orders) {
      bool stays = true;
      surefoot::Rng rng(1234, run);
      surefoot::walk(
          sigmaban::model(), sigmaban::noise(), one, Vec<3>::Zero(), rng,
          [&](Eigen::Index, const surefoot::Pose2& pose) { stays = stays && room.contains(pose.position()); });
      inside += stays ? 1 : 0;
    }
  }
  CHECK(inside / 2000.0 == doctest::Approx(0.99).epsilon(0.01));

  std::vector<Eigen::Matrix3Xd> ahead{Eigen::Matrix3Xd::Zero(3, 10)};
  ahead[0].row(0).setConstant(0.04);
  const surefoot::Box<2> line = surefoot::space_needed(sigmaban::Model(), surefoot::MotionNoise(), ahead, 2, 1);
  CHECK(line.low() == Vec<2>{0, 0});
  CHECK(line.high()[0] == doctest::Approx(0.4));
  CHECK(line.high()[1] == 0);
  CHECK_THROWS_AS(surefoot::space_needed(sigmaban::Model(), surefoot::MotionNoise(), ahead, 0, 1), MotionError);
}
