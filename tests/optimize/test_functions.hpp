// The usual test functions of continuous optimisation; every minimum is 0.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "surefoot/core/rng.hpp"

namespace surefoot::toy {

inline double sphere(const Eigen::VectorXd& x) { return x.squaredNorm(); }

/// Axes between 1 and 1000 times as steep: condition number 1e6.
inline double ellipsoid(const Eigen::VectorXd& x) {
  double sum = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    sum += std::pow(1e6, static_cast<double>(i) / static_cast<double>(x.size() - 1)) * x[i] * x[i];
  }
  return sum;
}

/// A bent valley; the minimum is at (1, ..., 1), and from 4 dimensions on there is a second, local one.
inline double rosenbrock(const Eigen::VectorXd& x) {
  double sum = 0;
  for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
    sum += 100 * std::pow(x[i] * x[i] - x[i + 1], 2) + std::pow(x[i] - 1, 2);
  }
  return sum;
}

/// A local minimum at about every point of integer coordinates.
inline double rastrigin(const Eigen::VectorXd& x) {
  double sum = 0;
  for (const double v : x) sum += v * v + 10 - 10 * std::cos(2 * std::numbers::pi * v);
  return sum;
}

/// Uniform in [-width, width]^dimension, another one for every seed.
inline Eigen::VectorXd random_start(Eigen::Index dimension, double width, std::uint64_t seed) {
  Rng rng(seed, 0x5747);
  Eigen::VectorXd start(dimension);
  for (double& x : start) x = rng.uniform(-width, width);
  return start;
}

}  // namespace surefoot::toy
