// Choice, among many sequences of commands, of those that tell most about a walk. A final pose adds up 25 cycles of
// noise and tells little about commands that wander at random and cancel; commands that are held tell several times as
// much.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"
#include "surefoot/motion/plan/command_plan.hpp"

namespace surefoot {

/// Sequences that go to a drawn command as fast as the bounds allow, each component being 0 or one of its bounds, and
/// hold it; now and then (after 12 cycles on average) to another. Arguments, columns and errors as of plan_commands.
std::vector<Eigen::Matrix3Xd> plan_held_commands(const CommandBounds& bounds, int sequences, int cycles,
                                                 std::uint64_t seed);

struct InformativeOptions {
  CommandBounds bounds = {};
  int sequences = 25;                                      // to choose
  int cycles = 25;                                         // of each
  bool every_pose = false;                                 // whether all poses will be measured, or the last only
  int candidates = 400;                                    // of each kind: wandering and held
  double reach = std::numeric_limits<double>::infinity();  // farthest from the start, by the model without noise [m]
};

/// Throws MotionError, naming the field.
void check(const InformativeOptions& options);

/// Commands to calibrate from, one matrix per sequence (as plan_commands): greedy D-optimal design (Fedorov, "Theory of
/// Optimal Experiments", 1972), one sequence after the other such that the determinant of the information grows most,
/// from what the tracker knows: for a robot not yet calibrated, one of the default model. The information is worked out
/// at the tracker's parameters. Throws MotionError for bounds and counts that plan_commands refuses, and if no
/// candidate stays within reach. Cost: one Jacobian of fit_model per candidate, one factorisation per candidate and
/// sequence.
std::vector<Eigen::Matrix3Xd> plan_informative_commands(const MotionTracker& tracker, const InformativeOptions& options,
                                                        std::uint64_t seed);

/// Commands that a calibrated robot walks again and again to show that nothing has changed.
struct CheckPlan {
  std::vector<Eigen::Matrix3Xd> commands;
  double seen = 0;  // non-centrality of the change that is hardest to see, over all sequences; an alarm needs some 45
};

/// Chosen such that the change of a single parameter that is hardest to see among `jumps` (0: not watched) is seen
/// best: the smallest non-centrality of the test of change_alarm.hpp is made as large as exchanging single sequences
/// can make it. Errors and cost as above, several times.
CheckPlan plan_check_commands(const MotionTracker& tracker, const Eigen::VectorXd& jumps,
                              const InformativeOptions& options, std::uint64_t seed);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/plan/informative_commands.ipp"
#endif
