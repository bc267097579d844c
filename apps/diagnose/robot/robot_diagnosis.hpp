// Results of the diagnosis of a robot: those of any diagnosis, and what joints and groups add to it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "simulate_robot.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "terms.hpp"

namespace diagnose_robot {

/// Errors of one joint, in its unit: of the angle, or of the torque where torques drive.
struct JointError {
  std::string joint, group, unit;
  double textbook = 0, nominal = 0, after = 0, held_out = 0, noise = 0;
  double torque = 0;  // root mean square of the drive's [N m]
};

/// Whether a joint has more or less of something than its group.
struct JointDifference {
  std::string joint, group, effect, parameter, unit;
  double difference = 0, standard_error = 0, of_group = 0;
  bool differs = false;  // named; otherwise ruled out beyond the interval
};

/// Friction or rotor inertia that was not named, with the size that it would have beside what was.
struct SizeNotNamed {
  std::string place, effect, parameter, unit;
  double value = 0, standard_error = 0;
};

/// What no size of would show in the recordings, such as the offset of an encoder on a vertical axis.
struct InvisibleEffect {
  std::string joint, effect, parameter;
};

/// Where a number of the result went.
struct AugmentedEntry {
  std::string joint, effect, parameter, unit;
  double value = 0, in_file = 0;
  std::string where;  // attribute of MJCF, or the function of augmented.hpp
};

/// Torque that is left, in bins of speed.
struct TorquePicture {
  std::string joint, unit;
  Eigen::VectorXd speed, rigid, after;
};

struct AngleCurve {
  std::string joint;
  Eigen::VectorXd time, measured, nominal, after;
};

struct RobotDiagnosis {
  surefoot::Diagnosis common;
  RobotPhysics physics;
  std::vector<StartState> starts;  // of recordings: where simulations with these physics begin
  bool torque_driven = false;
  std::string error_unit;  // rad, or the share of the drives' torque
  double textbook = 0, nominal = 0, after = 0, held_out = 0, noise = 0;
  double replayed = 0;  // error of augmented.xml in MuJoCo's own step; NaN: not replayed
  double step = 0;      // [s] of the simulation
  std::vector<JointError> joints;
  std::vector<JointDifference> differences;
  std::vector<SizeNotNamed> not_named;
  std::vector<InvisibleEffect> invisible;
  std::vector<AugmentedEntry> augmented;
  std::vector<std::string> effect_columns;  // of shares
  Eigen::MatrixXd shares;                   // joint x effect: share of the error that goes with it
  std::vector<TorquePicture> torques;
  std::vector<AngleCurve> curves;
};

struct VerdictCriteria {
  double beyond_noise = 1.5;  // times the noise floor: more than that is unexplained, as for one joint
  double same = 0.02;         // of the error: less is no improvement, as for one joint
};

/// The verdict from counts and errors alone. `noise` NaN: unknown.
surefoot::Verdict verdict_of(std::size_t effects, std::size_t calibrated, double after, double noise, bool complete,
                             const VerdictCriteria& criteria = {});

}  // namespace diagnose_robot
