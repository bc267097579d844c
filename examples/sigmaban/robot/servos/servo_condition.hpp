// The condition of one servo as far as its driver knows it, and what follows from each finding: a table as a function.
#pragma once

#include <cstdint>
#include <string_view>

namespace dynamixel {

enum class Condition : std::uint8_t {
  working,
  silent,     // no answers
  returned,   // answers again, but it is not known yet whether it was reset meanwhile
  restoring,  // was reset: has been given its settings and its torque again, which is to be seen
  failed      // for good
};

/// What is found out about a servo.
enum class Finding : std::uint8_t {
  fit,              // torque on, settings as they were, no error
  reset,            // torque off or settings lost, no error: it was rebooted, or somebody wrote to it
  shut_down,        // overload, overheating or electrical shock: the servo itself switched its torque off
  broken,           // its encoder says nothing any more
  implausible,      // it measures a motion that no servo makes: another joint's, or none's
  fell_silent,      // no answers for a few cycles
  heard,            // the first answer after that
  silent_for_long,  // still no answers
};

/// What is done, by severity. To let go is to switch the torque of all off at once; to sit down, to do so after the
/// robot sits.
enum class Reaction : std::uint8_t { go_on, restore, sit_down, let_go };

constexpr std::string_view in_words(Finding finding) {
  constexpr std::string_view words[] = {"works",
                                        "lost its torque or its settings",
                                        "shut itself down (overload, heat or electrical shock)",
                                        "has a broken encoder",
                                        "measures a motion that no servo makes; were ids swapped?",
                                        "is silent",
                                        "is back",
                                        "was silent for too long"};
  return words[static_cast<std::size_t>(finding)];
}

struct ServoCondition {
  Condition condition = Condition::working;
  int attempts = 0;  // of the restoration under way
  int restored = 0;  // times it was reset and works again

  bool operator==(const ServoCondition&) const = default;
};

struct ConditionCriteria {
  int most_attempts = 3;  // to restore: nobody acknowledges a broadcast, and one in a hundred is lost
  int most_restored = 2;  // a servo that is reset a third time has a cause that lasts, such as a loose plug
};

struct ConditionStep {
  ServoCondition next;
  Reaction reaction = Reaction::go_on;

  bool operator==(const ConditionStep&) const = default;
};

namespace servo_condition_detail {

/// Found reset: restored again, as long as there is hope.
constexpr ConditionStep after_reset(ServoCondition servo, const ConditionCriteria& criteria) {
  const bool again = servo.condition == Condition::restoring;
  const int attempts = again ? servo.attempts + 1 : 1;
  if (attempts > criteria.most_attempts || servo.restored >= criteria.most_restored) {
    servo.condition = Condition::failed;
    return {servo, Reaction::sit_down};
  }
  servo.condition = Condition::restoring;
  servo.attempts = attempts;
  return {servo, Reaction::restore};
}

constexpr ConditionStep after_fit(ServoCondition servo) {
  if (servo.condition == Condition::restoring) ++servo.restored;
  servo.condition = Condition::working;
  servo.attempts = 0;
  return {servo, Reaction::go_on};
}

}  // namespace servo_condition_detail

/// What a servo in that condition is in after a finding, and what is to be done.
constexpr ConditionStep after(ServoCondition servo, Finding finding, const ConditionCriteria& criteria = {}) {
  const auto failed = [&](Reaction reaction) {
    servo.condition = Condition::failed;
    return ConditionStep{servo, reaction};
  };
  if (finding == Finding::broken || finding == Finding::implausible) return failed(Reaction::let_go);
  if (servo.condition == Condition::failed) return {servo, Reaction::go_on};
  switch (finding) {
    case Finding::fit:
      return servo_condition_detail::after_fit(servo);
    case Finding::reset:
      return servo_condition_detail::after_reset(servo, criteria);
    case Finding::fell_silent:
      servo.condition = Condition::silent;
      return {servo, Reaction::go_on};
    case Finding::heard:
      if (servo.condition == Condition::silent) servo.condition = Condition::returned;
      return {servo, Reaction::go_on};
    default:  // shut_down, silent_for_long
      return failed(Reaction::sit_down);
  }
}

/// How many servos of a group are in a bad way.
struct GroupCondition {
  int joints = 0;
  int limp = 0;                // restoring or failed
  int silent = 0;              // with those that have just returned
  double silence_lasts_s = 0;  // since that many were silent [s]
};

struct GroupCriteria {
  double most_limp = 0.25;      // share of joints: with more, a robot falls, whatever the others do
  double most_silent = 0.34;    // share of joints, for longer than the next: the line is broken
  double line_is_dead_s = 0.3;  // longer than one servo takes to start [s]
};

/// What the whole asks for, beyond what each servo does.
constexpr Reaction group_reaction(const GroupCondition& group, const GroupCriteria& criteria = {}) {
  const auto more_than = [&](int count, double share) { return count > 1 && count > share * group.joints; };
  if (more_than(group.limp, criteria.most_limp)) return Reaction::let_go;
  const bool all = group.silent == group.joints;
  const bool dead =
      (all || more_than(group.silent, criteria.most_silent)) && group.silence_lasts_s > criteria.line_is_dead_s;
  return dead ? Reaction::let_go : Reaction::go_on;
}

}  // namespace dynamixel
