// The files that the diagnosis of a robot leaves: diagnosis.json, report.html, augmented.xml, augmented.hpp; and the
// summary.
#pragma once

#include <string>

#include "augmented_xml.hpp"
#include "robot_diagnosis.hpp"

namespace diagnose_robot {

/// The keys of any diagnosis, and "robot" with joints, groups, differences and the table of the corrected model.
std::string robot_json(const RobotDiagnosis& diagnosis);

std::string robot_report(const RobotDiagnosis& diagnosis);

std::string robot_summary(const RobotDiagnosis& diagnosis, const std::string& report);

}  // namespace diagnose_robot
