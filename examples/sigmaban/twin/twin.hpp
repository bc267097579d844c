// The robot in MuJoCo: joint targets in, trunk pose out.
//
// Runs repeat bit for bit on one machine and build, not between machines: contacts make the walk chaotic.
#pragma once

#include <array>
#include <memory>

#include "../robot/balance/body_reading.hpp"
#include "../robot/walk_engine/joint_targets.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/vec.hpp"
#include "twin_parameters.hpp"
#include "twin_switches.hpp"

struct mjModel_;
struct mjData_;

namespace sigmaban {

/// One robot on its ground. Poses are those of the trunk in the plane of the ground: origin between the hips, the angle
/// is the direction it looks in. Not for several threads at once; different twins are.
class Twin {
 public:
  /// Throws TwinError for switches that are out of their range and for parameters that MuJoCo refuses.
  explicit Twin(const TwinParameters& parameters = {}, const TwinSwitches& switches = {});

  /// At the origin, looking along x, joints at these targets, the left foot flat on the ground, nothing moving.
  void reset(const JointTargets& stand);

  /// One command period with these targets. Throws TwinError for targets that are not finite.
  void drive(const JointTargets& targets);

  /// On the trunk's centre of mass, in the ground's frame, until it is changed or the twin is reset [N].
  void push(const surefoot::Vec<3>& force);

  surefoot::Pose2 pose() const;

  /// What the trunk's sensors and load cells in the feet measure, as means over the last command period.
  const BodyReading& reading() const { return reading_; }

  /// Of the point between the hips above the ground [m].
  double height() const;

  /// Whether the trunk leans by more than 45 degrees, or the physics has failed.
  bool fallen() const;

  /// What the servos measure, in the order of joint_names [rad]: free play lies behind them.
  std::array<double, 12> joint_positions() const;

  /// What they were told last, in the order of joint_names [rad].
  std::array<double, 12> joint_goals() const;

  /// What they draw, in the order of joint_names [A].
  std::array<double, 12> joint_currents() const;

  /// The torques that the servos' voltages cause, in the order of joint_names [N m].
  std::array<double, 12> joint_torques() const;

  /// The middles of both soles (left, right) [m].
  std::array<surefoot::Vec<3>, 2> soles() const;

  surefoot::Vec<3> gravity() const;  // [m/s^2]
  double mass() const;               // [kg]
  double time() const;               // since the reset [s]

  const TwinParameters& parameters() const { return parameters_; }
  const TwinSwitches& switches() const { return switches_; }

  /// For rendering.
  const mjModel_& model() const { return *model_; }
  mjData_& data() { return *data_; }

 private:
  struct Free {
    void operator()(mjModel_* model) const;
    void operator()(mjData_* data) const;
  };

  void set_frictions();
  void add_loads();
  double zero(std::size_t joint) const { return switches_.at(joint) ? switches_.joint_zero : 0; }

  TwinParameters parameters_;
  TwinSwitches switches_;
  std::unique_ptr<mjModel_, Free> model_;
  std::unique_ptr<mjData_, Free> data_;
  int trunk_ = 0;
  std::array<int, 2> foot_{};       // bodies
  std::array<int, 12> position_{};  // of the joints among all coordinates
  std::array<int, 8> cleat_{};      // geoms
  BodyReading reading_;
  int steps_per_order_ = 1;
};

}  // namespace sigmaban
