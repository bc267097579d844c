// The measured states of the joints of a group: which answers to believe, and their alarms.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "../bus/statistics.hpp"
#include "joint.hpp"
#include "servo_group_types.hpp"

namespace dynamixel {

/// How an answer was taken.
enum class Plausibility : std::uint8_t { taken, doubted, implausible };

/// Nothing is allocated after construction. `joints` must outlive this.
class JointStates {
 public:
  explicit JointStates(const std::vector<Joint>& joints) : joints_(&joints), states_(joints.size()) { forget(); }

  std::span<const JointState> all() const { return states_; }
  JointState& operator[](std::size_t i) { return states_[i]; }
  const JointState& operator[](std::size_t i) const { return states_[i]; }

  /// As if none had ever answered.
  void forget() {
    for (JointState& state : states_) {
      state.measured = Time::min();
      state.alarms = {};
      state.implausible = 0;
    }
  }
  bool heard(std::size_t i) const { return states_[i].measured > Time::min(); }

  /// Position and velocity; `check` compares with the answer before.
  Plausibility take_motion(std::size_t i, const ServoState& servo, Time now, const CareOptions& care, bool check) {
    JointState& state = states_[i];
    const double position = joint_angle((*joints_)[i], servo.angle_rad);
    if (check && heard(i)) {
      const double most = care.jump_rad + care.fastest_rad_per_s * to_seconds(now - state.measured);
      if (std::abs(position - state.position_rad) > most) {
        return ++state.implausible < care.most_implausible ? Plausibility::doubted : Plausibility::implausible;
      }
    }
    state.implausible = 0;
    state.position_rad = position;
    state.velocity_rad_per_s = (*joints_)[i].sign * servo.velocity_rad_per_s;
    state.current_a = (*joints_)[i].sign * servo.current_a;
    state.measured = now;
    return Plausibility::taken;
  }

  /// Voltage and temperature; note(kind) is called for each alarm that comes or goes.
  template <class Note>
  void take_supply(std::size_t i, const ServoState& servo, const AlarmOptions& options, ServoStatistics& statistics,
                   Note note) {
    JointState& state = states_[i];
    state.voltage_v = servo.voltage_v;
    state.temperature_celsius = servo.temperature_celsius;
    note_voltage(statistics, servo.voltage_v);
    note_temperature(statistics, servo.temperature_celsius);
    const Alarms alarms = update_alarms(state.alarms, servo.temperature_celsius, servo.voltage_v, options);
    if (alarms.hot != state.alarms.hot) note(alarms.hot ? ServoEventKind::hot : ServoEventKind::cool);
    if (alarms.voltage != state.alarms.voltage) {
      note(alarms.voltage ? ServoEventKind::voltage_wrong : ServoEventKind::voltage_right);
    }
    state.alarms = alarms;
  }

 private:
  const std::vector<Joint>* joints_;
  std::vector<JointState> states_;
};

}  // namespace dynamixel
