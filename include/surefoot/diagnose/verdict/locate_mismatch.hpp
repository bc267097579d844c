// Location of the mismatch: where in the motion, and when in the recordings, the calibrated model is off.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/verdict/fitted_model.hpp"

namespace surefoot::diagnosis {

struct LocationCriteria {
  Eigen::Index rows = 4000;   // to look at; more tell nothing new
  Eigen::Index horizon = 10;  // rows over which whole simulations drift off in one context
  int conditions = 2;         // of a rule: more cannot be read
  int permutations = 60;      // for a p-value down to 1.6 %
  std::size_t intervals = 6;  // to show
};

using MismatchLocation = std::pair<std::vector<MismatchRegion>, std::vector<MismatchInterval>>;

/// The region of the motion and the stretches of time that hold most of it; nothing where only final poses were
/// measured.
MismatchLocation locate_mismatch(const EstimationSetup& setup, const FittedModel& calibrated, std::uint64_t seed,
                                 const LocationCriteria& criteria = {});

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/locate_mismatch.ipp"
#endif
