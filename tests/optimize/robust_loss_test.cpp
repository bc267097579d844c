#include "surefoot/optimize/robust_loss.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace surefoot {
namespace {

constexpr Loss all[] = {Loss::squared, Loss::huber, Loss::cauchy};

TEST_CASE("weight and slope are the first and second derivative of the loss") {
  for (const Loss loss : all) {
    for (double r = -3.05; r < 3; r += 0.1) {
      const double h = 1e-5;
      const auto rho = [&](double x) { return loss_terms(loss, x).rho; };
      const auto psi = [&](double x) { return loss_terms(loss, x).weight * x; };
      CHECK(psi(r) == doctest::Approx((rho(r + h) - rho(r - h)) / (4 * h)).epsilon(1e-6));
      CHECK(loss_terms(loss, r).slope == doctest::Approx((psi(r + h) - psi(r - h)) / (2 * h)).epsilon(1e-6));
    }
  }
}

TEST_CASE("small residuals count as squares, large ones less than that where the loss is robust") {
  for (const Loss loss : all) CHECK(loss_terms(loss, 1e-3).rho == doctest::Approx(1e-6).epsilon(1e-5));
  CHECK(loss_terms(Loss::squared, 10).rho == 100);
  CHECK(loss_terms(Loss::huber, 10).rho == 19);
  CHECK(loss_terms(Loss::cauchy, 10).rho == doctest::Approx(std::log(101)));
}

}  // namespace
}  // namespace surefoot
