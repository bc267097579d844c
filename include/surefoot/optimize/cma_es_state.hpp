// State of one descent of CMA-ES between two generations, as a plain struct.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>

namespace surefoot {

/// More candidates in a generation than this are a mistake.
inline constexpr Eigen::Index max_population = 1'000'000;

/// The search distribution is N(mean, sigma^2 C). Memory: two matrices of dimension^2 doubles and the histories.
struct CmaEsState {
  std::uint64_t seed = 0;  // with `descent` and `generation` it names the random numbers of a generation
  std::uint64_t descent = 0;
  std::uint64_t generation = 0;
  Eigen::Index population = 0;

  Eigen::VectorXd mean;
  double sigma = 0;
  double start_sigma = 0;
  Eigen::MatrixXd covariance;  // C: the lower triangle, zeros above
  Eigen::MatrixXd factor;      // lower triangular A with A A^T = C as it was at the last factorisation
  bool degenerate = false;     // the last factorisation found C not positive definite
  Eigen::VectorXd path_sigma;  // evolution path of the step size, in the coordinates of A^-1
  Eigen::VectorXd path;        // evolution path of the covariance

  double value_range = 0;               // worst minus best value of the last generation
  std::deque<double> best_values = {};  // of the last generations, newest last, as far back as a stop criterion looks
  std::deque<double> median_values = {};

  Eigen::Index dimension() const { return mean.size(); }

  /// How far back the stop criteria look [generations]: the stagnation window of the tutorial (appendix B.3).
  std::size_t shortest_history() const { return 120 + static_cast<std::size_t>(30 * dimension() / population); }
  std::size_t history() const { return std::clamp<std::size_t>(generation / 5, shortest_history(), 20'000); }
};

}  // namespace surefoot
