#include "surefoot/optimize/cma_es_core.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "surefoot/optimize/cma_es_constants.hpp"
#include "tests/optimize/test_functions.hpp"

namespace surefoot {
namespace {

using Eigen::VectorXd;

template <class F>
std::vector<double> values_of(const F& function, const Eigen::MatrixXd& candidates) {
  std::vector<double> values;
  for (Eigen::Index i = 0; i < candidates.cols(); ++i) values.push_back(function(candidates.col(i)));
  return values;
}

TEST_CASE("the constants are those of the tutorial's table") {
  // Worked out by hand for n = 10, population 10.
  const CmaEsConstants c = cma_es_constants(10, default_population(10));
  CHECK(default_population(10) == 10);
  CHECK(c.parents == 5);
  CHECK(c.weights.head(5).sum() == doctest::Approx(1));
  CHECK(c.weights[0] == doctest::Approx(0.45627265));
  CHECK(c.mu_eff == doctest::Approx(3.1672992));
  CHECK(c.c_sigma == doctest::Approx(0.28442859));
  CHECK(c.damping == doctest::Approx(1.28442859));
  CHECK(c.c_path == doctest::Approx(0.29499038));
  CHECK(c.c_one == doctest::Approx(0.015283824));
  CHECK(c.c_mu == doctest::Approx(0.023551777));
  CHECK(c.normal_norm == doctest::Approx(std::sqrt(10.0) * (1 - 1 / 40.0 + 1 / 2100.0)));
}

TEST_CASE("weights fall with the rank, and the negative ones cannot make the covariance indefinite") {
  for (const Eigen::Index n : {1, 2, 5, 20, 100}) {
    for (const Eigen::Index population : {4, 5, 10, 37, 500}) {
      const CmaEsConstants c = cma_es_constants(n, population);
      for (Eigen::Index i = 1; i < population; ++i) CHECK(c.weights[i] <= c.weights[i - 1]);
      const double negative = -c.weights.tail(population - c.parents).sum();
      CHECK(negative >= 0);
      // What is left of C in the worst direction when every bad step points there (tutorial, equation 52).
      CHECK(1 - c.c_one - c.c_mu - static_cast<double>(n) * c.c_mu * negative >= -1e-12);
      CHECK(c.c_one + c.c_mu <= 1);
    }
  }
}

TEST_CASE("candidates are the same until they are told, and new ones after") {
  CmaEsCore core(cma_es_start(VectorXd::Ones(4), 0.5, 8, 3));
  const Eigen::MatrixXd first = core.ask();
  CHECK(core.ask() == first);
  core.tell(values_of(toy::sphere, first));
  CHECK(core.ask() != first);
}

TEST_CASE("the first candidates are normally distributed around the start") {
  const VectorXd start{{5, -3}};
  CmaEsCore core(cma_es_start(start, 0.5, 20'000, 3));
  const Eigen::MatrixXd z = (core.ask().colwise() - start) / 0.5;
  const Eigen::Matrix2d covariance = z * z.transpose() / static_cast<double>(z.cols());
  CHECK(z.rowwise().mean().norm() < 0.03);  // 3 standard errors: 0.021 each
  CHECK((covariance - Eigen::Matrix2d::Identity()).norm() < 0.06);
}

TEST_CASE("only the order of the values matters") {
  CmaEsCore plain(cma_es_start(VectorXd::Ones(5), 0.5, 9, 4)), warped(cma_es_start(VectorXd::Ones(5), 0.5, 9, 4));
  for (int generation = 0; generation < 50; ++generation) {
    plain.tell(values_of(toy::sphere, plain.ask()));
    warped.tell(values_of([](const VectorXd& x) { return std::exp(std::sqrt(toy::sphere(x))) - 7; }, warped.ask()));
  }
  CHECK(plain.state().mean == warped.state().mean);
  CHECK(plain.state().covariance == warped.state().covariance);
}

TEST_CASE("the covariance learns the inverse of the objective's curvature") {
  CmaEsCore core(cma_es_start(VectorXd::Ones(3), 0.5, 12, 5));
  const VectorXd curvature{{1, 100, 10'000}};
  const auto f = [&](const VectorXd& x) { return x.cwiseProduct(curvature).dot(x); };
  for (int generation = 0; generation < 150; ++generation) core.tell(values_of(f, core.ask()));
  const VectorXd scaled = core.state().covariance.diagonal().cwiseProduct(curvature);
  CHECK(scaled.maxCoeff() / scaled.minCoeff() < 10);
}

TEST_CASE("the factor is that of the covariance, and the covariance stays positive definite") {
  CmaEsCore core(cma_es_start(toy::random_start(6, 1, 6), 0.5, 9, 6));
  for (int generation = 0; generation < 200; ++generation) {
    core.tell(values_of(toy::rosenbrock, core.ask()));
    REQUIRE_FALSE(core.state().degenerate);
  }
  const Eigen::MatrixXd c = core.state().covariance.selfadjointView<Eigen::Lower>();
  CHECK((core.state().factor * core.state().factor.transpose()).isApprox(c, 1e-10));
  CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(c).eigenvalues().minCoeff() > 0);
}

TEST_CASE("a core made from another's state goes on with the same bits") {
  CmaEsCore whole(cma_es_start(VectorXd::Ones(40), 0.5, 15, 7));
  for (int generation = 0; generation < 30; ++generation) whole.tell(values_of(toy::ellipsoid, whole.ask()));
  CmaEsCore resumed(whole.state());
  for (int generation = 0; generation < 30; ++generation) {
    whole.tell(values_of(toy::ellipsoid, whole.ask()));
    resumed.tell(values_of(toy::ellipsoid, resumed.ask()));
  }
  CHECK(whole.state().mean == resumed.state().mean);
  CHECK(whole.state().sigma == resumed.state().sigma);
}

TEST_CASE("values that are not finite rank last") {
  const double bad[] = {std::nan(""), std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
  for (const double value : bad) {
    CmaEsCore with_bad(cma_es_start(VectorXd::Ones(3), 0.5, 8, 8)),
        with_worst(cma_es_start(VectorXd::Ones(3), 0.5, 8, 8));
    with_bad.ask();
    with_worst.ask();
    with_bad.tell(std::vector<double>{3, 1, value, 2, 5, 4, 7, 6});
    with_worst.tell(std::vector<double>{3, 1, 8, 2, 5, 4, 7, 6});
    CHECK(with_bad.state().mean == with_worst.state().mean);
    CHECK(with_bad.state().covariance == with_worst.state().covariance);
  }
}

TEST_CASE("a generation without any finite value, and a wrong number of values, are refused") {
  CmaEsCore core(cma_es_start(VectorXd::Ones(3), 0.5, 4, 9));
  CHECK_THROWS_AS(core.tell(std::vector<double>{1, 2, 3, 4}), OptimizeError);  // not asked
  core.ask();
  CHECK_THROWS_AS(core.tell(std::vector<double>{1, 2, 3}), OptimizeError);
  CHECK_THROWS_WITH_AS(core.tell(std::vector<double>(4, std::nan(""))),
                       doctest::Contains("not finite at any of the 4 candidates of generation 0"), OptimizeError);
}

TEST_CASE("a wrong start is refused in a sentence") {
  CHECK_THROWS_AS(cma_es_start(VectorXd(0), 0.5, 8, 1), OptimizeError);
  CHECK_THROWS_AS(cma_es_start(VectorXd{{std::nan("")}}, 0.5, 8, 1), OptimizeError);
  CHECK_THROWS_WITH_AS(cma_es_start(VectorXd::Ones(2), 0, 8, 1), doctest::Contains("sigma must be positive"),
                       OptimizeError);
  CHECK_THROWS_WITH_AS(cma_es_start(VectorXd::Ones(2), 1, 3, 1), doctest::Contains("at least 4, got 3"), OptimizeError);
}

}  // namespace
}  // namespace surefoot
