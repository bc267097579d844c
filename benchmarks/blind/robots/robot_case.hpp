// A blind robot: a model, and what the real one has beyond it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "random.hpp"

namespace blind_robots {

/// What a real joint, its drive and its link have beyond the model.
struct HiddenJoint {
  double coulomb = 0, viscous = 0, load_friction = 0, armature = 0;  // [N m], [N m s/rad], [1], [kg m^2]
  double delay = 0, backlash = 0, missing_limit = 0, weakness = 0;   // [s], [rad], [1], [1]
  double mass_error = 0, payload = 0, bias = 0;                      // [1], [kg], [rad]
};

struct Joint {
  std::string name, group, parent;
  char axis = 'y';
  double length = 0.2, mass = 1, offset = 0;  // [m] along -z of the link before; offset: sideways, of legs
  double kp = 0, kd = 0, limit = 0;           // drive
  double torque = 1, inertia = 0.1;           // what the link and those behind it weigh at most on the joint
  HiddenJoint hidden;
};

struct RobotCase {
  std::string family;  // arm2, arm6, arm7, legs12
  bool torque_driven = false;
  std::vector<Joint> joints;
  std::vector<std::pair<std::size_t, std::size_t>> swapped;
  nlohmann::ordered_json truth;  // list of { effect, place, parameter, value }
};

inline constexpr double file_armature = 0.01;  // [kg m^2], which the model states and the robot has

/// Everything follows from the generator. `faults`: so many; without a number one to three, or swapped columns.
RobotCase draw_robot(plants::Random& random, const std::string& family, std::optional<int> faults);

/// As MJCF; `real`: with masses and frictions that the model leaves out.
std::string robot_xml(const RobotCase& robot, bool real);

/// As the setup file of surefoot-diagnose.
std::string robot_setup(const RobotCase& robot);

struct RecordingLength {
  double seconds = 6;
  double row_period = 0.005;  // [s], a multiple of the simulation's step of 0.0005 s
};

/// One recording as CSV: the robot follows random goals, in MuJoCo with small explicit steps.
std::string record(const RobotCase& robot, plants::Random& random, const RecordingLength& length = {});

}  // namespace blind_robots
