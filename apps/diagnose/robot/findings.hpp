// What a search has found, in words, tables and pictures.
#pragma once

#include "robot_diagnosis.hpp"
#include "search_terms.hpp"

namespace diagnose_robot {

inline constexpr double z95 = 1.96;  // 95 % of a normal distribution lie within so many standard deviations

inline bool is_torque_driven(const Evidence& evidence) { return evidence.robot.setup.drive == DriveKind::torque; }

/// Errors of all joints in one number: root mean square angle, or share of the drives' torque.
double overall(const Evidence& evidence, const Eigen::VectorXd& rms);

/// Noise of angles, or of torques with what that of the angles makes of speeds and accelerations.
Eigen::VectorXd noise_by_joint(const Evidence& evidence, const RobotPhysics& physics, std::uint64_t seed);

void name_effects(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& diagnosis);
void name_alternatives(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& diagnosis);

/// Remarks of what no size of would show.
void name_invisible(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& diagnosis);

/// Single joints against what their group has: named, or ruled out.
void compare_with_groups(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& diagnosis);

/// Share of each joint's error that goes with an effect, all of its places together.
void share_errors(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& diagnosis);

/// Recorded torques of the other sign are a fault of the log.
void name_sign_faults(const Evidence& evidence, RobotDiagnosis& diagnosis);

/// Curves of the joints with the largest errors.
void draw_worst(const Evidence& evidence, RobotDiagnosis& diagnosis);

/// Verdict and sentence.
void conclude(const Evidence& evidence, RobotDiagnosis& diagnosis);

}  // namespace diagnose_robot
