// Sequences as if their commands had come later by whole cycles.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot::detail {

/// The sequence from a later cycle on, seen from the pose before it; as it is, if that was not measured.
WalkSequence without_first(const WalkSequence& sequence, Eigen::Index cycles);

/// The sequences as if every command had come later by so many cycles, without their first cycles, at least those whose
/// commands are not known then.
std::vector<WalkSequence> delayed(std::span<const WalkSequence> sequences, int cycles, int first = 0);

/// Whether commands change within sequences, and not only from one to the next: without that no delay can be seen, and
/// the start of a walk passes for one.
bool commands_vary(std::span<const WalkSequence> sequences);

/// Delays [cycles] of the new walk against the old one, none first; commands come later by 0 to `largest` in both.
std::vector<int> possible_delays(int former, int largest);

}  // namespace surefoot::detail

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/changes/delayed_commands.ipp"
#endif
