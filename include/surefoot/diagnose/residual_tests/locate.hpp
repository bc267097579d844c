// Location of a mismatch: the region of the motion, as a readable rule, and the stretches of time where most of it is.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/residual_tests/features.hpp"

namespace surefoot::diagnosis {

/// Mismatch energy of each sample of the table: of the change of the residuals over the last `horizon` rows, which
/// belongs to that context, or of the residuals themselves (horizon 0), where each is a prediction from the row before.
Eigen::VectorXd mismatch_energy(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                const std::vector<SimulatedRun>& trajectories, const Eigen::VectorXd& sigma,
                                const FeatureTable& table, Eigen::Index horizon);

/// feature < threshold, or not.
struct Condition {
  Eigen::Index feature = -1;
  double threshold = 0;
  bool below = true;
  double score = 0;

  bool holds(const FeatureTable& table, Eigen::Index sample) const {
    return (table.values(feature, sample) < threshold) == below;
  }
};

/// Thresholds tried for each feature: its deciles.
std::vector<std::vector<double>> deciles(const FeatureTable& table);

/// The condition that holds most energy beyond its share of samples, within what `inside` allows. The score is the gain
/// in between-group variance, as in a regression tree.
Condition best_condition(const FeatureTable& table, const std::vector<std::vector<double>>& cuts,
                         const Eigen::VectorXd& energy, const std::vector<bool>& inside);

std::string in_words(const FeatureTable& table, const Condition& condition);

/// A rule of at most `conditions` conditions that holds the most energy. Its p-value is that of its first condition
/// among rules found after blocks of the energies were dealt anew over time.
std::vector<MismatchRegion> find_region(const FeatureTable& table, const Eigen::VectorXd& energy, int conditions,
                                        int permutations, std::uint64_t seed);

/// The stretches, a twentieth of a recording each, that hold most energy.
std::vector<MismatchInterval> find_intervals(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                             const FeatureTable& table, const Eigen::VectorXd& energy,
                                             std::size_t count);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/residual_tests/locate.ipp"
#endif
