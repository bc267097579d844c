// The conditions of the servos of a group: whom to ask next, what became of each, and what that asks of the whole.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "../bus/transport.hpp"
#include "servo_condition.hpp"

namespace dynamixel {

struct CareOptions {
  double poll_s = 3e-3;           // that asking one servo for its health may take in a cycle [s]
  double silent_longest_s = 1.5;  // a servo that starts anew is back within half a second [s]
  double restore_s = 1.0;         // of the ramp after a reset [s]
  double fastest_rad_per_s = 20;  // twice what an MX-64 turns at 14.8 V: faster is no motion of its own
  double jump_rad = 0.2;          // that counts as none, however short the time [rad]
  int most_implausible = 3;       // answers in a row; one may be damage that passed the check sum
  ConditionCriteria condition{};
  GroupCriteria group{};
};

/// Why a group sits down or lets go.
struct ServoFault {
  std::size_t joint = 0;
  Finding finding = Finding::fit;
};

/// Nothing is allocated after construction. Has no clock and no bus: it is told the time and the findings.
class ServoCare {
 public:
  ServoCare(std::size_t joints, const CareOptions& options) : options_(options), conditions_(joints) {}

  /// All work, nothing is asked for.
  void begin() {
    std::fill(conditions_.begin(), conditions_.end(), ServoCondition{});
    reaction_ = Reaction::go_on;
    fault_.reset();
    many_silent_since_.reset();
  }

  /// Takes a finding, and returns what is to be done for that joint.
  Reaction take(std::size_t joint, Finding finding) {
    const ConditionStep step = after(conditions_[joint], finding, options_.condition);
    conditions_[joint] = step.next;
    demand(step.reaction, {joint, finding});
    return step.reaction;
  }

  /// Looks at the group as a whole.
  void look(Time now) {
    GroupCondition group{.joints = static_cast<int>(conditions_.size())};
    std::size_t worst = 0;
    for (std::size_t i = 0; i < conditions_.size(); ++i) {
      const Condition condition = conditions_[i].condition;
      group.limp += condition == Condition::restoring || condition == Condition::failed ? 1 : 0;
      group.silent += condition == Condition::silent || condition == Condition::returned ? 1 : 0;
      if (condition != Condition::working) worst = i;
    }
    if (group.silent <= options_.group.most_silent * group.joints) {
      many_silent_since_.reset();
    } else if (!many_silent_since_) {
      many_silent_since_ = now;
    }
    group.silence_lasts_s = many_silent_since_ ? to_seconds(now - *many_silent_since_) : 0;
    const bool limp = conditions_[worst].condition == Condition::restoring;
    demand(group_reaction(group, options_.group), {worst, limp ? Finding::reset : Finding::silent_for_long});
  }

  /// Whose health to ask for in this cycle: every other time one whose torque is in doubt, else each in turn. None
  /// where all are silent. `alert` says whether a joint's last answer had error bits.
  template <class Alert>
  std::optional<std::size_t> next_to_ask(Alert alert) {
    ++cycles_;
    if (cycles_ % 2 == 0) {
      if (const auto urgent = search(urgent_, [&](std::size_t i) { return in_doubt(i) || alert(i); })) return urgent;
    }
    return search(turn_, [&](std::size_t i) { return conditions_[i].condition != Condition::silent; });
  }

  Condition condition(std::size_t joint) const { return conditions_[joint].condition; }
  /// The most severe so far.
  Reaction reaction() const { return reaction_; }
  const std::optional<ServoFault>& fault() const { return fault_; }

 private:
  bool in_doubt(std::size_t joint) const {
    const Condition condition = conditions_[joint].condition;
    return condition == Condition::returned || condition == Condition::restoring;
  }

  /// The next from `place` on; moves it.
  template <class Wanted>
  std::optional<std::size_t> search(std::size_t& place, Wanted wanted) const {
    for (std::size_t i = 0; i < conditions_.size(); ++i) {
      place = (place + 1) % conditions_.size();
      if (wanted(place)) return place;
    }
    return std::nullopt;
  }

  void demand(Reaction reaction, const ServoFault& fault) {
    if (reaction < Reaction::sit_down || reaction <= reaction_) return;
    reaction_ = reaction;
    if (!fault_) fault_ = fault;
  }

  CareOptions options_;
  std::vector<ServoCondition> conditions_;
  std::optional<Time> many_silent_since_;
  std::optional<ServoFault> fault_;
  Reaction reaction_ = Reaction::go_on;
  std::size_t turn_ = 0, urgent_ = 0;
  std::size_t cycles_ = 0;
};

}  // namespace dynamixel
