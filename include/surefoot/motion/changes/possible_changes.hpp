// Changes of a walk that are looked for: of each coefficient of its motion model, of the gain of one side alone, and of
// when it responds.
#pragma once

#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/changes/sparse_changes.hpp"

namespace surefoot::detail {

/// Sides are looked at where the model has them and they were calibrated. `jump` is in widths of the ranges of the
/// coefficients, `delay` in cycles.
std::vector<WalkChange> possible_changes(const AnyMotionModel& before, double jump, double delay,
                                         bool sides_calibrated);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/changes/possible_changes.ipp"
#endif
