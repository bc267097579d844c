// Detection limits: the smallest effects that would have been found.
#pragma once

#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/selection/propose.hpp"

namespace surefoot::diagnosis {

/// Limits of those proposals that have a strength and can be seen at a size that is not far beyond the one at which
/// they were sought, by name: of each effect and place the plain form, or that which shows first.
std::vector<DetectionLimit> detection_limits(const BoundSimulator& bound, const std::vector<Proposal>& proposals);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/detection_limits.ipp"
#endif
