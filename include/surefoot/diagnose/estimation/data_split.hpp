// Split of the recordings: those for the fit and the choice, and those held out.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace surefoot::diagnosis {

struct RecordingSplit {
  std::vector<std::size_t> training, held_out;
  std::vector<std::vector<std::size_t>> folds;  // of the training recordings
  bool cross_fitted = false;  // all recordings are both: each is held out of the fit to the other folds (cross-fitting)
};

/// Held-out recordings are those named, or a random share, never all and at least one; or, with a share of 0, each in
/// turn. The rest is dealt into folds, up to two more than asked for if each recording is then left out alone.
RecordingSplit split_recordings(const std::vector<Recording>& recordings, const std::vector<std::string>& held_out,
                                double share, std::size_t folds, std::uint64_t seed);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/estimation/data_split.ipp"
#endif
