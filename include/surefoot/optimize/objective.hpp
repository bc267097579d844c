// The concept of a function to be minimised.
#pragma once

#include <Eigen/Core>
#include <concepts>

#include "surefoot/core/error.hpp"
#include "surefoot/core/rng.hpp"

namespace surefoot {

/// A function to be minimised that gives the same value at the same point: `[](const Eigen::VectorXd& x) -> double`.
template <class F>
concept ExactObjective = requires(const F& objective, const Eigen::VectorXd& x) {
  { objective(x) } -> std::convertible_to<double>;
};

/// A function to be minimised in the mean over its random numbers, all drawn from the stream it is given:
/// `[](const Eigen::VectorXd& x, surefoot::Rng& rng) -> double`.
template <class F>
concept NoisyObjective = !ExactObjective<F> && requires(const F& objective, const Eigen::VectorXd& x, Rng& rng) {
  { objective(x, rng) } -> std::convertible_to<double>;
};

/// Either. It must be safe to call from several threads; a value that is not finite counts as worse than all others.
template <class F>
concept Objective = ExactObjective<F> || NoisyObjective<F>;

}  // namespace surefoot
