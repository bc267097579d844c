#include "motion.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "../../../apps/calibrate/motion_file/motion_file.hpp"
#include "../../../apps/common/command.hpp"
#include "../../../apps/common/files.hpp"
#include "../../../apps/common/usage_error.hpp"
#include "results.hpp"

namespace sigmaban {
namespace {

/// The parameters of the walk that a policy was trained for, as its record says; none: the published walk.
std::vector<double> walk_in_record(const nlohmann::json& record) {
  std::vector<double> walk;
  const auto found = record.find("walk");
  if (found == record.end() || !found->is_array()) return walk;
  for (const auto& number : *found) walk.push_back(number.is_number() ? number.get<double>() : std::nan(""));
  return walk;
}

}  // namespace

void add_motion_option(example::Command& command, std::string& file) {
  command
      .add_option("--motion", file,
                  "motion.json of surefoot-calibrate: walk and noise of your robot in place of the published ones")
      ->check(example::existing_file());
}

CalibratedApproach calibrated_approach(const std::string& problem_name, const std::string& file) {
  const calibrate_program::MotionFile motion = calibrate_program::read_motion_file(file);
  auto problem = problem_name == "ha" ? CalibratedApproach::ha() : CalibratedApproach::anha();
  problem.constants.turn_first = false;
  problem.walk = motion.model;
  problem.noise = motion.noise;
  return problem;
}

void check_motion(const std::filesystem::path& policy, const std::string& motion_file) {
  if (!exists(record_of(policy))) return;
  const auto record = nlohmann::json::parse(example::read_text(record_of(policy)), nullptr, false);
  if (!record.is_object()) return;
  const auto walk_in = [](const std::string& file) {
    if (file.empty()) return std::vector<double>();
    const surefoot::Vec<21> parameters = calibrate_program::read_motion_file(file).model.parameters();
    return std::vector<double>(parameters.begin(), parameters.end());
  };
  if (walk_in_record(record) == walk_in(motion_file)) return;
  throw example::UsageError(policy.string() + ": was trained for another walk" +
                            (record.contains("motion") && record["motion"].is_string()
                                 ? "; say --motion " + record["motion"].get<std::string>()
                                 : ", the published one; leave --motion out"));
}

}  // namespace sigmaban
