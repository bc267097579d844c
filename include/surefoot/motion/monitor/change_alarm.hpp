// Alarm that a robot no longer walks as calibrated: the generalised likelihood ratio of a jump of one parameter, or of
// all, before any of the last sequences, against none. Willsky and Jones, "A generalized likelihood ratio approach to
// the detection and estimation of jumps in linear systems", IEEE Transactions on Automatic Control 21, 1976; Basseville
// and Nikiforov, "Detection of Abrupt Changes", 1993, chapter 7. What is not known of the parameters before the jump is
// averaged over. Cost of a sequence: window * (parameters + 1)^3 operations, and the update of the tracker.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <string>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

struct AlarmOptions {
  int window = 20;               // [sequences] that a change is looked for in; at least 2
  double outlier_threshold = 5;  // a sequence this surprising is an outlier [deviations of a normal number]
  double jump_deviation = 0.1;   // standard deviation of a change of all parameters at once [widths of their ranges]
};

/// Throws MotionError, naming the field.
void check(const AlarmOptions& options);

/// What changed, since when, and by how much.
struct Change {
  static constexpr int all = -1;

  int parameter = all;                  // which one; its name is in parameter_info() of the model
  Eigen::Index since = 0;               // number of the first sequence after the change, counted from 1
  Eigen::VectorXd jump = {};            // by parameter, in its unit
  Eigen::VectorXd standard_error = {};  // of the jump; 0 where nothing changed
  double evidence = 0;                  // log likelihood ratio [nats], see ChangeAlarm
};

namespace detail {

/// A sequence of the window, with the tracker as it was before.
struct RecentSequence {
  Eigen::Index number = 0;
  MotionTracker before;
  InformationUpdate update;
};

}  // namespace detail

/// An alarm is raised when the evidence of a change is above the threshold. Evidence is the log likelihood ratio of
/// the likeliest change, but no more than twice what is left of it without any one of its sequences: a single wrong
/// reading raises nothing, at least two sequences must agree. The tracker does not learn from an outlier; it still
/// counts as evidence, together with others.
struct ChangeAlarm {
  MotionTracker tracker;  // start it as calibrated
  double threshold = 0;   // [nats], from alarm_threshold
  AlarmOptions options = {};

  std::deque<detail::RecentSequence> recent = {};  // the last sequences, at most `window`
  Eigen::Index count = 0;                          // of all sequences so far
};

struct AlarmReport {
  Surprise surprise = {};             // of this sequence
  bool outlier = false;               // too surprising by itself: probably a wrong reading
  double evidence = 0;                // [nats]
  std::optional<Change> change = {};  // the alarm
};

/// Takes one more sequence. A change is reported again after every sequence until `adapt` is called. Throws MotionError
/// if the sequence cannot be used; the alarm is then as it was.
AlarmReport update(ChangeAlarm& alarm, const WalkSequence& sequence);

/// Accepts a change that `update` has just reported: what changed is learnt anew from the sequences since, the rest is
/// kept. Throws MotionError if those sequences have left the window.
void adapt(ChangeAlarm& alarm, const Change& change);

/// The change of a model as a sentence, e.g. "dx per dx changed by 0.26 +- 0.05 since sequence 31."
std::string describe(const Change& change, const AnyMotionModel& model);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/monitor/change_alarm.ipp"
#endif
