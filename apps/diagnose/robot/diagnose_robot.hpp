// The diagnosis of a robot, stage by stage: search, proof on held-out blocks, joints against their groups, verdict.
#pragma once

#include "robot_diagnosis.hpp"
#include "search_terms.hpp"

namespace diagnose_robot {

RobotDiagnosis diagnose_robot(const Evidence& evidence, const Progress& progress);

/// What is said of a log whose faults forbid to say more.
RobotDiagnosis refuse_log(const Evidence& evidence, const std::vector<surefoot::LogFault>& faults);

/// Replaces the figures of held-out blocks by those of recordings that were used for nothing.
void hold_out(const Evidence& test, RobotDiagnosis& diagnosis);

}  // namespace diagnose_robot
