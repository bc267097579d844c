#include "surefoot/optimize/least_squares.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <limits>

#include "surefoot/core/rng.hpp"

namespace surefoot {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A line y = a + b t seen with normal noise of standard deviation 0.1.
struct Line {
  MatrixXd inputs;  // columns: 1, t
  VectorXd seen;
  explicit Line(std::uint64_t seed, Eigen::Index points = 50) : inputs(points, 2), seen(points) {
    Rng rng(seed, 77);
    for (Eigen::Index i = 0; i < points; ++i) {
      inputs.row(i) << 1, rng.uniform(0, 10);
      seen[i] = 3 - 0.5 * inputs(i, 1) + 0.1 * rng.normal();
    }
  }
  VectorXd operator()(const VectorXd& p) const { return inputs * p - seen; }
};

TEST_CASE("a linear problem gives the solution and the covariance of the normal equations") {
  const Line line(1);
  const LeastSquaresResult fit = least_squares(line, VectorXd::Zero(2));
  const MatrixXd inverse = (line.inputs.transpose() * line.inputs).inverse();
  const VectorXd solution = inverse * line.inputs.transpose() * line.seen;
  CHECK(fit.x.isApprox(solution, 1e-8));
  const double variance = line(solution).squaredNorm() / 48;
  CHECK(fit.deviation == doctest::Approx(std::sqrt(variance)));
  CHECK(fit.covariance.isApprox(variance * inverse, 1e-6));
  CHECK(fit.rank == 2);
  CHECK(fit.cost == doctest::Approx(0.5 * fit.residuals.squaredNorm()));
  CHECK(fit.iterations < 10);
}

TEST_CASE("the covariance is that of the estimates over many data sets") {
  MatrixXd predicted = MatrixXd::Zero(2, 2), seen = MatrixXd::Zero(2, 2);
  constexpr int sets = 400;
  const VectorXd truth{{3, -0.5}};
  for (int i = 0; i < sets; ++i) {
    const LeastSquaresResult fit = least_squares(Line(static_cast<std::uint64_t>(i), 20), VectorXd::Zero(2));
    predicted += fit.covariance / sets;
    seen += (fit.x - truth) * (fit.x - truth).transpose() / sets;
  }
  // A variance over 400 sets has a standard error of 7 %.
  CHECK(seen(0, 0) / predicted(0, 0) == doctest::Approx(1).epsilon(0.25));
  CHECK(seen(1, 1) / predicted(1, 1) == doctest::Approx(1).epsilon(0.25));
}

TEST_CASE("hard classics are solved to their known solutions") {
  const auto rosenbrock = [](const VectorXd& x) { return VectorXd{{10 * (x[1] - x[0] * x[0]), 1 - x[0]}}; };
  const LeastSquaresResult valley = least_squares(rosenbrock, VectorXd{{-1.2, 1}});
  CHECK(valley.x.isApprox(VectorXd::Ones(2), 1e-6));

  // Powell's singular function: the Jacobian loses rank at the minimum.
  const auto powell = [](const VectorXd& x) {
    return VectorXd{{x[0] + 10 * x[1], std::sqrt(5.0) * (x[2] - x[3]), std::pow(x[1] - 2 * x[2], 2),
                     std::sqrt(10.0) * std::pow(x[0] - x[3], 2)}};
  };
  CHECK(least_squares(powell, VectorXd{{3, -1, 0, 1}}).cost < 1e-12);

  // NIST StRD Misra1a, with its certified values and standard deviations.
  const VectorXd volume{
      {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78}};
  const VectorXd pressure{
      {77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0}};
  const auto misra = [&](const VectorXd& b) -> VectorXd {
    return (b[0] * (1 - (-b[1] * pressure.array()).exp())).matrix() - volume;
  };
  const auto misra_jacobian = [&](const VectorXd& b) {
    MatrixXd j(14, 2);
    j.col(0) = 1 - (-b[1] * pressure.array()).exp();
    j.col(1) = b[0] * pressure.array() * (-b[1] * pressure.array()).exp();
    return j;
  };
  for (const VectorXd& start : {VectorXd{{500, 1e-4}}, VectorXd{{250, 5e-4}}}) {
    const LeastSquaresResult fit = least_squares(misra, start, {}, misra_jacobian);
    CHECK(fit.x[0] == doctest::Approx(2.3894212918e+02).epsilon(1e-6));
    CHECK(fit.x[1] == doctest::Approx(5.5015643181e-04).epsilon(1e-6));
    CHECK(2 * fit.cost == doctest::Approx(1.2455138894e-01).epsilon(1e-8));
    CHECK(std::sqrt(fit.covariance(0, 0)) == doctest::Approx(2.7070075241).epsilon(1e-5));
    CHECK(std::sqrt(fit.covariance(1, 1)) == doctest::Approx(7.2668688436e-06).epsilon(1e-5));
  }
}

TEST_CASE("with a box the solution is the best point inside, and held parameters have variance 0") {
  const Line line(2);
  const LeastSquaresResult fit =
      least_squares(line, VectorXd{{1, 0}}, {.box = Box<Eigen::Dynamic>{VectorXd{{0, -0.4}}, VectorXd{{10, 1}}}});
  CHECK(fit.x[1] == -0.4);
  // With the slope held, the offset is a mean.
  CHECK(fit.x[0] == doctest::Approx((line.seen + 0.4 * line.inputs.col(1)).mean()));
  CHECK(fit.active_bound[1]);
  CHECK_FALSE(fit.active_bound[0]);
  CHECK(fit.covariance(1, 1) == 0);
  CHECK(fit.covariance(0, 0) == doctest::Approx(fit.deviation * fit.deviation / 50));
}

TEST_CASE("a start in the wrong corner of the box, with all parameters held at first, still gets away") {
  const auto f = [](const VectorXd& x) { return VectorXd{{x[0] - 2, 10 * (x[1] - x[0])}}; };
  const LeastSquaresResult fit =
      least_squares(f, VectorXd{{0, 5}}, {.box = Box<Eigen::Dynamic>{VectorXd{{0, 0}}, VectorXd{{5, 5}}}});
  CHECK(fit.x.isApprox(VectorXd{{2, 2}}, 1e-6));
}

TEST_CASE("robust losses ignore outliers that spoil the squared one") {
  Line line(3, 100);
  for (Eigen::Index i = 0; i < 10; ++i) line.seen[i] += 50;
  const VectorXd truth{{3, -0.5}};
  const auto error = [&](Loss loss) {
    return (least_squares(line, VectorXd::Zero(2), {.loss = loss, .loss_scale = 0.2}).x - truth).norm();
  };
  CHECK(error(Loss::squared) > 1);
  CHECK(error(Loss::huber) < 0.15);
  CHECK(error(Loss::cauchy) < 0.1);
}

TEST_CASE("without outliers the covariance of a robust fit is a little larger than that of the squared loss") {
  const Line line(4, 2000);
  const double plain = least_squares(line, VectorXd::Zero(2)).covariance(1, 1);
  for (const Loss loss : {Loss::huber, Loss::cauchy}) {
    const double robust = least_squares(line, VectorXd::Zero(2), {.loss = loss, .loss_scale = 0.2}).covariance(1, 1);
    CHECK(robust > 0.95 * plain);
    CHECK(robust < 1.3 * plain);
  }
}

TEST_CASE("parameters that the residuals do not determine have infinite variance, the others a finite one") {
  const Line line(5);
  // The first two parameters only act as a sum.
  const auto f = [&](const VectorXd& p) -> VectorXd { return line(VectorXd{{p[0] + p[1], p[2]}}); };
  const LeastSquaresResult fit = least_squares(f, VectorXd::Zero(3));
  CHECK(fit.x[0] + fit.x[1] == doctest::Approx(3).epsilon(0.05));
  CHECK(fit.rank == 2);
  CHECK(std::isinf(fit.covariance(0, 0)));
  CHECK(std::isinf(fit.covariance(1, 1)));
  CHECK(std::isnan(fit.covariance(0, 2)));
  CHECK(fit.covariance(2, 2) == doctest::Approx(least_squares(line, VectorXd::Zero(2)).covariance(1, 1)).epsilon(0.05));
}

TEST_CASE("as many parameters as residuals: a solution, but no idea how good") {
  const auto f = [](const VectorXd& x) { return VectorXd{{x[0] - 1, x[1] + 2}}; };
  const LeastSquaresResult fit = least_squares(f, VectorXd::Zero(2));
  CHECK(fit.x.isApprox(VectorXd{{1, -2}}, 1e-9));
  CHECK(std::isinf(fit.deviation));
  CHECK(std::isinf(fit.covariance(0, 0)));
}

TEST_CASE("points where the residuals are not finite are stepped back from") {
  // The first full step would leave the domain of the logarithm.
  const auto f = [](const VectorXd& x) { return VectorXd{{std::log(x[0]) + 5, 0.001 * x[0]}}; };
  const LeastSquaresResult fit = least_squares(f, VectorXd{{1}});
  CHECK(fit.x[0] == doctest::Approx(std::exp(-5.0)).epsilon(1e-4));
}

// Two damped oscillations that overlap, without noise.
struct Oscillations {
  VectorXd truth = VectorXd{{1, 0.3, 2, 0.7, 0.5, 3.1}};
  static VectorXd at(const VectorXd& p) {
    const VectorXd t = VectorXd::LinSpaced(200, 0, 10);
    return (p[0] * (-p[1] * t.array()).exp() * (p[2] * t.array()).cos() +
            p[3] * (-p[4] * t.array()).exp() * (p[5] * t.array()).cos())
        .matrix();
  }
  VectorXd operator()(const VectorXd& p) const { return at(p) - at(truth); }
};

TEST_CASE("secant steps lead to the same minimum with fewer Jacobians") {
  const Oscillations oscillations;
  const VectorXd start = oscillations.truth.array() * 1.1;
  const auto jacobians_with = [&](int secant_steps) {
    int count = 0;
    const auto jacobian = [&](const VectorXd& x) -> MatrixXd {
      ++count;
      return numeric_jacobian(oscillations, x, {});
    };
    const LeastSquaresResult fit = least_squares(oscillations, start, {.secant_steps = secant_steps}, jacobian);
    CHECK(fit.x.isApprox(oscillations.truth, 1e-6));
    CHECK(fit.covariance.diagonal().allFinite());
    return count;
  };
  CHECK(2 * jacobians_with(3) < jacobians_with(0) + 3);
}

TEST_CASE("a fit with secant steps ends only where a Jacobian says so") {
  const auto rosenbrock = [](const VectorXd& x) { return VectorXd{{10 * (x[1] - x[0] * x[0]), 1 - x[0]}}; };
  const LeastSquaresResult valley = least_squares(rosenbrock, VectorXd{{-1.2, 1}}, {.secant_steps = 5});
  CHECK(valley.x.isApprox(VectorXd::Ones(2), 1e-6));
  CHECK_THROWS_AS(least_squares(rosenbrock, VectorXd{{-1.2, 1}}, {.secant_steps = -1}), OptimizeError);
}

TEST_CASE("it says why it stopped") {
  const Line line(6);
  CHECK(least_squares(line, VectorXd::Zero(2), {.max_iterations = 0}).reason == LeastSquaresStop::max_iterations);
  CHECK(least_squares(line, VectorXd::Zero(2), {.tol_gradient = 1e-6, .tol_step = 0, .tol_cost = 0}).reason ==
        LeastSquaresStop::gradient);
  CHECK(least_squares(line, VectorXd::Zero(2), {.tol_gradient = 0, .tol_step = 1e-3, .tol_cost = 0}).reason ==
        LeastSquaresStop::step);
  CHECK(least_squares(line, VectorXd::Zero(2), {.tol_gradient = 0, .tol_step = 0, .tol_cost = 1e-3}).reason ==
        LeastSquaresStop::cost);
}

TEST_CASE("without the covariance it goes the same way with one Jacobian fewer") {
  const Line line(6);
  for (const int iterations : {1, 2, 100}) {
    int with = 0, without = 0;
    const auto counted = [&](int& count) {
      return [&line, &count](const VectorXd& x) -> MatrixXd {
        ++count;
        return numeric_jacobian(line, x, {});
      };
    };
    LeastSquaresOptions options{.max_iterations = iterations, .tol_gradient = 0, .tol_step = 0, .tol_cost = 1e-3};
    const LeastSquaresResult all = least_squares(line, VectorXd::Zero(2), options, counted(with));
    options.covariance = false;
    const LeastSquaresResult fast = least_squares(line, VectorXd::Zero(2), options, counted(without));
    CHECK(fast.x == all.x);
    CHECK(fast.residuals == all.residuals);
    CHECK(fast.reason == all.reason);
    CHECK(fast.iterations == all.iterations);
    CHECK(fast.covariance.size() == 0);
    CHECK(without == with - 1);
  }
}

TEST_CASE("wrong starts and shapes are refused") {
  const auto f = [](const VectorXd& x) -> VectorXd { return x; };
  const auto undefined = [](const VectorXd& x) -> VectorXd {
    return VectorXd::Constant(x.size(), std::numeric_limits<double>::quiet_NaN());
  };
  const auto transposed = [](const VectorXd&) -> MatrixXd { return MatrixXd::Ones(1, 2); };
  CHECK_THROWS_AS(least_squares(f, VectorXd(0)), OptimizeError);
  CHECK_THROWS_AS(least_squares(undefined, VectorXd::Ones(2)), OptimizeError);
  CHECK_THROWS_AS(least_squares(f, VectorXd::Ones(2), {}, transposed), OptimizeError);
  CHECK_THROWS_AS(least_squares(f, VectorXd::Ones(2), {.loss_scale = 0}), OptimizeError);
  CHECK_THROWS_AS(least_squares(f, VectorXd::Ones(2), {.box = Box<Eigen::Dynamic>::symmetric(VectorXd::Zero(2))}),
                  OptimizeError);
}

}  // namespace
}  // namespace surefoot
