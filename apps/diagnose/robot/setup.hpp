// How a log belongs to a robot: columns of joints, drives, groups of equal motors. A TOML file, schema
// surefoot.robot/1.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace diagnose_robot {

enum class DriveKind : unsigned char { position, torque };

/// A column and what turns its numbers into SI units.
struct ColumnOf {
  std::string name;
  double factor = 1;  // pi/180 for degrees
};

struct JointSetup {
  std::string name;
  ColumnOf goal, angle, speed, torque;  // those that are not there have no name
  double kp = 0, kd = 0;                // [N m/rad], [N m s/rad], of a position drive
  double limit = 0;                     // [N m], 0: none
};

struct Group {
  std::string name;
  std::vector<std::string> joints;
};

struct RobotSetup {
  std::string file;
  std::string time = "t_s";
  double time_factor = 1;  // to seconds
  DriveKind drive = DriveKind::position;
  bool base_held = false;  // a floating base that was held in the recordings
  bool ignore_contacts = false;
  std::optional<std::array<double, 3>> gravity;  // none: that of the model
  double step = 0;                               // [s] of the simulation; 0: see simulation_step()
  bool calibrate_gains = true, calibrate_bodies = false;
  bool from_model = true;         // friction, damping and armature of the file are part of the nominal model
  std::vector<std::string> held;  // joints that did not move
  std::vector<JointSetup> joints;
  std::vector<Group> groups;  // joints with equal motors; every joint of `joints` is in one
};

/// Throws surefoot::DiagnoseError that names the place.
RobotSetup read_setup(const std::filesystem::path& file);
RobotSetup parse_setup(const std::string& text, const std::string& file);

/// As TOML, with `remarks` above it.
std::string setup_text(const RobotSetup& setup, const std::vector<std::string>& remarks);

}  // namespace diagnose_robot
