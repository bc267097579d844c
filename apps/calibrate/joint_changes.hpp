// Comparison of the joints of a walk with what they were before: which of them follows its goals in another way.
#pragma once

#include <string>
#include <vector>

#include "joint_log.hpp"

namespace calibrate_program {

/// One thing that is read off the log of a joint, before and after. Of how the joint lags behind its goal, in three
/// parts: always the same, with the sign of its speed, in proportion to its speed; and of its current, in two.
struct JointChange {
  std::string joint, what, unit;
  double before = 0, after = 0;
  double standard_error = 0;  // of the difference
  double difference() const { return after - before; }
};

struct JointComparison {
  std::vector<JointChange> all;      // by what, then by joint
  std::vector<JointChange> changed;  // beyond what the other joints changed by, the clearest first
  std::vector<JointChange> shifted;  // offsets of three joints or more, from which none stands out
  std::vector<JointChange> common;   // what changed alike in most joints; `joint` is empty, figures are medians
};

/// Throws UsageError where the logs have different joints.
JointComparison compare_joints(const JointLog& before, const JointLog& after);

std::string joint_report(const JointComparison& comparison);

}  // namespace calibrate_program
