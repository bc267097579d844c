// The likelihood of noise that grows with speed and remembers, and its maximum.
#include "surefoot/diagnose/residual_tests/noise_model.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "tests/diagnose/made_up_noise.hpp"

namespace surefoot::diagnosis {
namespace {

TEST_CASE("the likelihood is that of the Gaussian with the same covariance, gaps or not") {
  NoiseSeries series = toys::noise_series({.rest = 0.4, .growth = 0.3, .time = 0.05, .share = 0.7}, 30, 0.02, 1);
  for (Eigen::Index i = 10; i < 30; ++i) series.time[i] += 0.031 * static_cast<double>(i / 4);
  for (const ResidualNoise& model : {ResidualNoise{0.5, 0, 0, 0}, ResidualNoise{0.4, 0.3, 0, 0},
                                     ResidualNoise{0.5, 0, 0.04, 1}, ResidualNoise{0.3, 0.2, 0.06, 0.6}}) {
    const Eigen::Index n = series.value.size();
    Eigen::MatrixXd covariance(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        const double apart = std::abs(series.time[i] - series.time[j]);
        covariance(i, j) = i == j ? 1 : model.time > 0 ? model.share * std::exp(-apart / model.time) : 0;
        covariance(i, j) *= std::hypot(model.rest, model.growth * series.speed[i]) *
                            std::hypot(model.rest, model.growth * series.speed[j]);
      }
    }
    const Eigen::LDLT<Eigen::MatrixXd> ldlt(covariance);
    const double expected = -0.5 * (static_cast<double>(n) * std::log(2 * 3.14159265358979) +
                                    ldlt.vectorD().array().log().sum() + series.value.dot(ldlt.solve(series.value)));
    CHECK(log_likelihoods(model, series).sum() == doctest::Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("the fit finds the numbers of the noise, in intervals that hold them") {
  const ResidualNoise truth{.rest = 0.002, .growth = 0.001, .time = 0.012, .share = 0.8};
  const NoiseFit fit = fit_noise(toys::noise_recordings(truth, 12, 2000, 0.005, 3),
                                 {.memory = NoiseMemory::fading_and_white, .grows = true});
  for (const auto number :
       {&ResidualNoise::rest, &ResidualNoise::growth, &ResidualNoise::time, &ResidualNoise::share}) {
    CHECK(fit.model.*number == doctest::Approx(truth.*number).epsilon(0.1));
    CHECK(fit.low.*number < truth.*number);
    CHECK(fit.high.*number > truth.*number);
    CHECK(fit.high.*number < 1.3 * fit.low.*number);
  }
}

TEST_CASE("a fit with more numbers is never less likely") {
  const auto series = toys::noise_recordings({.rest = 1, .growth = 0.5, .time = 0.02, .share = 1}, 3, 300, 0.01, 4);
  const double white = fit_noise(series, {}).log_likelihood;
  const double grown = fit_noise(series, {.grows = true}).log_likelihood;
  const double fading = fit_noise(series, {.memory = NoiseMemory::fading, .grows = true}).log_likelihood;
  CHECK(grown > white);
  CHECK(fading > grown);
  CHECK(fit_noise(series, {.memory = NoiseMemory::fading_and_white, .grows = true}).log_likelihood > fading - 2);
}

}  // namespace
}  // namespace surefoot::diagnosis
