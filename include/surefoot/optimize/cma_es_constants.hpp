// The strategy constants of CMA-ES as functions of dimension and population.
// Hansen: "The CMA Evolution Strategy: A Tutorial", arXiv:1604.00772, Table 1 (equations 49 to 58).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace surefoot {

/// The population that the tutorial recommends (equation 48).
inline int default_population(Eigen::Index dimension) {
  return 4 + static_cast<int>(3 * std::log(static_cast<double>(dimension)));
}

struct CmaEsConstants {
  Eigen::VectorXd weights;  // by rank, best first: the first `parents` are positive and sum to 1, the rest is negative
  Eigen::Index parents = 0;
  double mu_eff = 0;       // variance effective number of parents
  double c_sigma = 0;      // learning rate of the path of the step size
  double damping = 0;      // of the step size
  double c_path = 0;       // learning rate of the path of the covariance
  double c_one = 0;        // learning rate of the rank-one update
  double c_mu = 0;         // learning rate of the rank-mu update
  double normal_norm = 0;  // expected length of a standard normal vector
  long factor_gap = 1;     // [generations] between two factorisations of the covariance
};

/// For dimension >= 1 and population >= 4.
CmaEsConstants cma_es_constants(Eigen::Index dimension, Eigen::Index population);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/optimize/cma_es_constants.ipp"
#endif
