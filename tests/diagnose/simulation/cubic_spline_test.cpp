// The smooth curve through rows.
#include "surefoot/diagnose/simulation/cubic_spline.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace surefoot::diagnosis {
namespace {

TEST_CASE(
    "a signal of an eighth of the sampling rate is met within a five hundredth, where straight lines miss a "
    "fifteenth") {
  constexpr int rows = 200;
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(rows, 0, rows - 1);
  const auto signal = [](double t) { return std::sin(std::numbers::pi / 4 * t); };
  const std::vector<double> bends = second_derivatives(times, times.unaryExpr(signal));
  REQUIRE(bends.size() == rows);
  double worst = 0, of_lines = 0;
  for (std::size_t row = 20; row < rows - 20; ++row) {  // ends are straight
    const auto t = static_cast<double>(row);
    for (const double share : {0.25, 0.5, 0.75}) {
      const double line = signal(t) + share * (signal(t + 1) - signal(t)), truth = signal(t + share);
      worst = std::max(worst, std::abs(line + bend_between(bends[row], bends[row + 1], 1, share) - truth));
      of_lines = std::max(of_lines, std::abs(line - truth));
    }
  }
  CHECK(worst < 2e-3);
  CHECK(of_lines > 0.07);
}

TEST_CASE("at unequal intervals a straight line stays one, and slopes meet at rows") {
  Eigen::VectorXd times(6), values(6);
  times << 0, 0.1, 0.4, 0.5, 1.2, 1.3;
  const std::vector<double> straight = second_derivatives(times, 3 * times);
  CHECK(std::all_of(straight.begin(), straight.end(), [](double bend) { return std::abs(bend) < 1e-12; }));
  values << 1, -2, 4, 0, 3, 3;
  const std::vector<double> bends = second_derivatives(times, values);
  CHECK(bends.front() == 0);
  CHECK(bends.back() == 0);
  const auto at = [&](std::size_t row, double share) {
    const auto r = static_cast<Eigen::Index>(row);
    const double interval = times[r + 1] - times[r];
    return values[r] + share * (values[r + 1] - values[r]) + bend_between(bends[row], bends[row + 1], interval, share);
  };
  constexpr double near = 1e-6;  // of an interval
  for (std::size_t row = 1; row + 1 < 6; ++row) {
    const auto r = static_cast<Eigen::Index>(row);
    const double before = (values[r] - at(row - 1, 1 - near)) / (near * (times[r] - times[r - 1]));
    const double after = (at(row, near) - values[r]) / (near * (times[r + 1] - times[r]));
    CHECK(before == doctest::Approx(after).epsilon(1e-3));
  }
}

TEST_CASE("two rows have a straight line between them") {
  CHECK(second_derivatives(Eigen::Vector2d(0, 1), Eigen::Vector2d(3, 5)).empty());
}

}  // namespace
}  // namespace surefoot::diagnosis
