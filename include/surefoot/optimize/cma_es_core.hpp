// One descent of CMA-ES, by ask and tell, without bounds, stop criteria or restarts.
//
// Hansen: "The CMA Evolution Strategy: A Tutorial", arXiv:1604.00772, figure 6 with active covariance update. One thing
// differs: candidates are mean + sigma A z with the Cholesky factor A of C in place of its symmetric root B D B^T, and
// the path of the step size averages z itself (Krause, Arbones, Igel: "CMA-ES with Optimal Covariance Update and
// Storage Complexity", NIPS 2016). The search is as good, and a factorisation costs a twentieth of an eigenvalue
// decomposition, so that A is hardly ever out of date.
// Cost of a generation of L candidates in n dimensions: L n normal draws, L n^2 products, and n^3 / 3 now and then.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/optimize/cma_es_constants.hpp"
#include "surefoot/optimize/cma_es_state.hpp"
#include "surefoot/optimize/linear_algebra.hpp"
#include "surefoot/optimize/objective.hpp"

namespace surefoot {

/// The state before the first generation of a descent from `start` with standard deviation `sigma` in every dimension.
CmaEsState cma_es_start(const Eigen::VectorXd& start, double sigma, Eigen::Index population, std::uint64_t seed,
                        std::uint64_t descent = 0);

///   CmaEsCore core(cma_es_start(start, sigma, default_population(start.size()), seed));
///   while (...) core.tell(values_of_columns(core.ask()));
class CmaEsCore {
 public:
  explicit CmaEsCore(CmaEsState state);

  const CmaEsState& state() const { return state_; }

  /// The candidates of this generation, one per column: the same ones until they are told.
  const Eigen::MatrixXd& ask();

  /// Learns from the values of the candidates, in their order; smaller is better, not finite is worst.
  /// Throws OptimizeError if none is finite.
  void tell(std::span<const double> values);

 private:
  void rank(std::span<const double> values);
  void move_mean();
  void adapt_covariance();
  void adapt_sigma();
  void record_values();
  void factorise();

  CmaEsState state_;
  CmaEsConstants constants_;
  Eigen::MatrixXd normal_;      // z, one per column
  Eigen::MatrixXd step_;        // A z
  Eigen::MatrixXd candidates_;  // mean + sigma A z
  bool asked_ = false;
  bool stalled_ = false;  // the path of the step size is so long that the other path waits

  std::vector<Eigen::Index> order_;  // candidates, best first
  std::vector<double> ranked_;       // their values
  Eigen::VectorXd mean_step_, mean_normal_, scaled_weights_;
};

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/cma_es_core.ipp"
#endif
