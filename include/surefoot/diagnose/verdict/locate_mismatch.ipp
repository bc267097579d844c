// Definitions of surefoot/diagnose/verdict/locate_mismatch.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/residual_tests/locate.hpp"
#include "surefoot/diagnose/verdict/locate_mismatch.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE MismatchLocation locate_mismatch(const EstimationSetup& setup, const FittedModel& calibrated,
                                               std::uint64_t seed, const LocationCriteria& criteria) {
  if (setup.noise == NoiseKind::final_pose) return {};
  const BoundSimulator& bound = setup.bound;
  const auto& recordings = setup.split.training;
  Eigen::Index rows = 0;
  for (const std::size_t r : recordings) rows += bound.recordings[r].rows();
  const Eigen::Index every = std::max<Eigen::Index>(1, rows / criteria.rows);
  const FeatureTable table = make_features(bound, recordings, calibrated.runs.training, every, InputsOf::own_row);
  const Eigen::Index horizon = setup.noise == NoiseKind::process ? 0 : criteria.horizon;
  const Eigen::VectorXd energy =
      mismatch_energy(bound, recordings, calibrated.runs.training, setup.problem.weighting.sigma, table, horizon);
  return {find_region(table, energy, criteria.conditions, criteria.permutations, seed),
          find_intervals(bound, recordings, table, energy, criteria.intervals)};
}

}  // namespace surefoot::diagnosis
