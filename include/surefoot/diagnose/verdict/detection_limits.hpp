// Detection limits: the smallest effects that would have been found.
#pragma once

#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/selection/propose.hpp"

namespace surefoot::diagnosis {

/// Limits of those proposals that have a strength and can be seen, by name.
std::vector<DetectionLimit> detection_limits(const BoundSimulator& bound, const std::vector<Proposal>& proposals);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/detection_limits.ipp"
#endif
