// The angles that the joints of a group are sent: wanted, within limits, taken over softly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../dynamixel/control_tables.hpp"
#include "joint.hpp"
#include "soft_start.hpp"

namespace dynamixel {

/// Nothing is allocated after construction. `joints` and `model` must outlive this.
class JointGoals {
 public:
  JointGoals(const std::vector<Joint>& joints, const ServoModel& model)
      : model_(&model), joints_(&joints), goals_(joints.size()), starts_(joints.size()), ticks_(joints.size()) {}

  /// What the joint should get to; clamped, or left as it was where `refuse`. False where that is beyond its limits.
  bool set(std::size_t i, double goal_rad, bool refuse) {
    const double within = std::clamp(goal_rad, (*joints_)[i].min_rad, (*joints_)[i].max_rad);
    if (within == goal_rad || !refuse) goals_[i] = within;
    return within == goal_rad;
  }
  /// The goal is where the joint is, within limits or not.
  void hold(std::size_t i, double position_rad) { goals_[i] = position_rad; }

  void begin_softly(std::size_t i, double from_rad, Time now, double duration_s) {
    starts_[i] = {now, from_rad, duration_s};
  }
  /// From what was sent last.
  void begin_softly(std::size_t i, Time now, double duration_s) { begin_softly(i, sent(i), now, duration_s); }

  /// For the servos, now.
  std::span<const std::uint32_t> ticks(Time now) {
    for (std::size_t i = 0; i < goals_.size(); ++i) {
      // a joint that starts beyond its limits comes back softly, too
      const double lowest = std::min((*joints_)[i].min_rad, starts_[i].from_rad);
      const double highest = std::max((*joints_)[i].max_rad, starts_[i].from_rad);
      const double softly = std::clamp(starts_[i](goals_[i], now), lowest, highest);
      const double within = std::clamp(servo_angle((*joints_)[i], softly), angle_of(*model_, 0),
                                       angle_of(*model_, 2 * model_->center - 1));
      ticks_[i] = ticks_of(*model_, within).value_or(model_->center);  // there always is one
    }
    return ticks_;
  }
  /// What the joint was sent last [rad].
  double sent(std::size_t i) const { return joint_angle((*joints_)[i], angle_of(*model_, ticks_[i])); }
  /// As sent last.
  const std::vector<std::uint32_t>& last_ticks() const { return ticks_; }

 private:
  const ServoModel* model_;
  const std::vector<Joint>* joints_;
  std::vector<double> goals_;  // [rad]
  std::vector<SoftStart> starts_;
  std::vector<std::uint32_t> ticks_;
};

}  // namespace dynamixel
