#include "surefoot/core/box.hpp"

#include <doctest/doctest.h>

#include <limits>

namespace surefoot {
namespace {

const Box<2> box(Vec<2>(-1, 10), Vec<2>(1, 14));

TEST_CASE("a box knows its bounds, width and centre") {
  CHECK(box.low() == Vec<2>(-1, 10));
  CHECK(box.high() == Vec<2>(1, 14));
  CHECK(box.width() == Vec<2>(2, 4));
  CHECK(box.center() == Vec<2>(0, 12));
  CHECK(box.size() == 2);
  CHECK(Box<2>::symmetric(Vec<2>(1, 2)).low() == Vec<2>(-1, -2));
}

TEST_CASE("a box contains its faces, and neither what is beyond nor what is not a number") {
  CHECK(box.contains(Vec<2>(0, 12)));
  CHECK(box.contains(Vec<2>(-1, 14)));
  CHECK_FALSE(box.contains(Vec<2>(-1.0001, 12)));
  CHECK_FALSE(box.contains(Vec<2>(0, 14.0001)));
  CHECK_FALSE(box.contains(Vec<2>(std::numeric_limits<double>::quiet_NaN(), 12)));
}

TEST_CASE("clamping gives the nearest point of the box") {
  CHECK(box.clamp(Vec<2>(0.5, 11)) == Vec<2>(0.5, 11));
  CHECK(box.clamp(Vec<2>(-7, 11)) == Vec<2>(-1, 11));
  CHECK(box.clamp(Vec<2>(3, 99)) == Vec<2>(1, 14));
}

TEST_CASE("the unit cube maps onto the box and back") {
  CHECK(box.from_unit(Vec<2>(0, 0)) == box.low());
  CHECK(box.from_unit(Vec<2>(1, 1)) == box.high());
  CHECK(box.from_unit(Vec<2>(0.25, 0.5)) == Vec<2>(-0.5, 12));
  CHECK(box.to_unit(Vec<2>(-0.5, 12)) == Vec<2>(0.25, 0.5));
}

TEST_CASE("a dimension without width maps to zero, and samples to its only value") {
  const Box<2> flat(Vec<2>(3, 0), Vec<2>(3, 1));
  CHECK(flat.to_unit(Vec<2>(3, 0.5)) == Vec<2>(0, 0.5));
  Rng rng(1);
  CHECK(flat.sample(rng)[0] == 3);
}

TEST_CASE("samples lie inside the box and reach into every quarter of it") {
  Rng rng(1);
  Eigen::Matrix2i hits = Eigen::Matrix2i::Zero();
  for (int i = 0; i < 200; ++i) {
    const Vec<2> point = box.sample(rng);
    REQUIRE(box.contains(point));
    ++hits(point[0] > 0, point[1] > 12);
  }
  CHECK(hits.minCoeff() > 20);
}

TEST_CASE("a box of run-time size works like one of fixed size") {
  const Box<Eigen::Dynamic> dynamic(Eigen::VectorXd::Constant(3, -1), Eigen::VectorXd::Constant(3, 2));
  CHECK(dynamic.size() == 3);
  CHECK(dynamic.clamp(Eigen::VectorXd::Constant(3, 5)) == Eigen::VectorXd::Constant(3, 2));
  Rng rng(1);
  CHECK(dynamic.contains(dynamic.sample(rng)));
}

TEST_CASE("impossible bounds are refused with the dimension and the values") {
  CHECK_THROWS_WITH_AS(Box<2>(Vec<2>(0, 1), Vec<2>(1, 0)), doctest::Contains("dimension 1"), CoreError);
  CHECK_THROWS_WITH_AS(Box<2>(Vec<2>(0, 1), Vec<2>(1, 0)), doctest::Contains("[1.000000, 0.000000]"), CoreError);
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(Box<1>(Vec<1>(0.0), Vec<1>(infinity)), CoreError);
  CHECK_THROWS_AS(Box<1>(Vec<1>(-infinity), Vec<1>(0.0)), CoreError);
  CHECK_THROWS_AS(Box<1>(Vec<1>(infinity - infinity), Vec<1>(0.0)), CoreError);
  CHECK_THROWS_AS(Box<Eigen::Dynamic>(Eigen::VectorXd::Zero(2), Eigen::VectorXd::Ones(3)), CoreError);
}

}  // namespace
}  // namespace surefoot
