// The stabilisation of the walk by what the body's sensors say.
//
// Three things, by time. Slowly, the trunk is shifted until the mean centre of pressure lies near the middle of the
// feet: a robot that stands over its toes falls forwards whatever pushes it, and so does one on a slope. Quickly, the
// ankle that carries the robot presses against a nodding of the trunk that is not usual at that phase of the walk; a
// walk that nothing disturbs stays as it is. And a robot that rocks sideways out of step with its walk takes the next
// step only when the weight has come to the foot that should carry it (Hofer and Rouxel, ICAPS 2017: an unexpected
// weight on the foot that should swing delays the phase).
#pragma once

#include <algorithm>

#include "../walk_engine/joint_targets.hpp"
#include "attitude.hpp"
#include "body_reading.hpp"
#include "phase_mean.hpp"

namespace sigmaban {

struct StabilizerOptions {
  double gate_phase = 0.1;        // of the cycle, after the foot that swings should have left the ground: published
  double support_share = 0.5;     // of the weight, that should be on the other foot by then
  double longest_wait_s = 0.4;    // more than that it does not rock back [s]
  double ankle_per_rate = 0.15;   // by how much the ankle turns against the rate of a nodding [rad s/rad]
  double pressure_x = 0.005;      // of the mean centre of pressure that is sought, ahead of the middle of the feet [m]
  double trim_per_pressure = 2;   // by which legs lean against the centre of pressure [rad/s per m]
  double largest_trim_rad = 0.2;  // 4 cm of the trunk: less than half of a foot [rad]
};

/// For an engine with a phase as that of SplineWalk.
class Stabilizer {
 public:
  explicit Stabilizer(const StabilizerOptions& options = {}) : options_(options), pressure_(options.pressure_x) {}

  /// A reading of the last `duration` [s]. `walking`: the engine takes full steps, at this phase.
  void feel(const BodyReading& reading, double duration, double phase, bool walking) {
    attitude_.update(reading, duration);
    const double load = reading.loads[0] + reading.loads[1];
    left_share_ = load > least_load_n ? reading.loads[0] / load : 0.5;
    nodding_ = 0;
    if (!walking) return;
    const surefoot::Vec<1> rate(reading.gyro.y());
    if (usual_.known()) nodding_ = (rate - usual_.at(phase))[0];
    usual_.add(phase, rate);
    if (load <= least_load_n) return;
    const double pressure =
        (reading.loads[0] * reading.pressure_x[0] + reading.loads[1] * reading.pressure_x[1]) / load;
    pressure_ += duration / pressure_memory_s * (pressure - pressure_);
    trim_ += options_.trim_per_pressure * (pressure_ - options_.pressure_x) * duration;
    trim_ = std::clamp(trim_, -options_.largest_trim_rad, options_.largest_trim_rad);
  }

  /// There is no reading of this period: nothing but the trim is kept.
  void feel_nothing() { nodding_ = 0; }

  /// Whether the phase waits for this period: the weight is not on the foot that should carry it.
  bool waits(double phase, double duration) {
    const double into = phase < 0.5 ? phase : phase - 0.5;
    const double share = phase < 0.5 ? left_share_ : 1 - left_share_;
    if (into < options_.gate_phase) waited_s_ = 0;
    const bool at_gate = into >= options_.gate_phase && into < options_.gate_phase + gate_width;
    if (!at_gate || share >= options_.support_share || waited_s_ >= options_.longest_wait_s) return false;
    waited_s_ += duration;
    return true;
  }

  /// Shifts the trunk back over both feet by the trim, and turns the ankle of the foot that carries the robot.
  void correct(JointTargets& targets, double phase) const {
    for (LegJoints* leg : {&targets.left, &targets.right}) {  // the trunk stays as upright as it was
      leg->ankle_pitch += trim_;
      leg->hip_pitch -= trim_;
    }
    LegJoints& carrying = phase < 0.5 ? targets.left : targets.right;
    carrying.ankle_pitch += options_.ankle_per_rate * nodding_;
  }

  const Attitude& attitude() const { return attitude_; }
  double trim() const { return trim_; }  // of both legs, > 0 backwards [rad]

 private:
  static constexpr double gate_width = 0.02;  // of the cycle: a control period at 1.7 Hz and 100 Hz
  static constexpr double least_load_n = 10;  // on both feet, a quarter of the robot: below it, it is in the air [N]
  static constexpr double pressure_memory_s = 0.6;  // a walk cycle: within one, the pressure goes from heel to toe [s]

  StabilizerOptions options_;
  Attitude attitude_;
  PhaseMean<1> usual_;  // rate of pitch [rad/s]
  double nodding_ = 0;  // rate of pitch beyond that [rad/s]
  double left_share_ = 0.5;
  double pressure_;  // mean of its centre, ahead of the middle of the feet [m]
  double trim_ = 0;
  double waited_s_ = 0;
};

}  // namespace sigmaban
