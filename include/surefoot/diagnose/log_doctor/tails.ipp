// Definitions of surefoot/diagnose/log_doctor/tails.hpp.
#pragma once

#include <cmath>
#include <limits>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/log_doctor/tails.hpp"

namespace surefoot::diagnosis {

/// Continued fraction of the incomplete beta function, by Lentz's method.
SUREFOOT_ONCE double beta_fraction(double x, double a, double b) {
  constexpr int most_terms = 300;      // it converges within some ten for the arguments that occur
  constexpr double tolerance = 1e-12;  // relative
  constexpr double tiny = 1e-300;      // in place of 0
  const auto away_from_zero = [](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1, d = 1 / away_from_zero(1 - (a + b) * x / (a + 1)), fraction = d;
  for (int i = 1; i < most_terms; ++i) {
    const double m = i;
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / away_from_zero(1 + even * d);
    c = away_from_zero(1 + even / c);
    fraction *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / away_from_zero(1 + odd * d);
    c = away_from_zero(1 + odd / c);
    fraction *= d * c;
    if (std::abs(d * c - 1) < tolerance) break;
  }
  return fraction;
}

SUREFOOT_ONCE double f_tail(double f, double d1, double d2) {
  if (!(d1 > 0 && d2 > 0)) return 1;
  if (!(f > 0)) return 1;
  if (!std::isfinite(f)) return 0;
  const double a = d2 / 2, b = d1 / 2, x = d2 / (d2 + d1 * f);
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(x, a, b) / a;
  return 1 - front * beta_fraction(1 - x, b, a) / b;
}

}  // namespace surefoot::diagnosis
