// Samples for the regression: states and their rates from smoothed readings, or the steps between measured poses.
#pragma once

#include <vector>

#include "machine.hpp"

namespace sparse {

struct Sample {
  const plants::Recording* recording = nullptr;
  Look at;
  Triple measured{};  // per component; NaN = not known
};

/// Rates by local parabolas over a window of rows; levels that are not measured are taken from `simulated`.
std::vector<Sample> collect(const Machine& machine, const plants::Recording& recording,
                            const plants::Values& parameters);

Sizes sizes_of(const std::vector<Sample>& samples);

}  // namespace sparse
