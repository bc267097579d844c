// A robot from an MJCF or URDF file, and what of it the diagnosis needs.
#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace diagnose_robot {

struct FreeModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct FreeData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPointer = std::unique_ptr<mjModel, FreeModel>;
using DataPointer = std::unique_ptr<mjData, FreeData>;

/// A joint with one degree of freedom.
struct ModelJoint {
  std::string name, class_name;  // class_name: of its defaults in the file, as far as it names one itself
  int id = 0, dof = 0, position = 0, body = 0;
  bool slides = false;                                 // [m] instead of [rad]
  double low = 0, high = 0;                            // range; both 0: none
  double torque_limit = 0;                             // of its actuator; 0: none
  double kp = 0, kd = 0;                               // of a position actuator in the file; 0: none
  double damping = 0, armature = 0, frictionloss = 0;  // as the file has them
  double tip[3] = {0, 0, 0};                           // of its link, in the frame of the body: where a payload sits
};

struct RobotModel {
  std::string file, name, text;  // text: what was loaded, with what was missing taken out
  ModelPointer model;
  std::vector<ModelJoint> joints;
  bool floating_base = false;
  std::vector<std::string> remarks;
};

/// Throws surefoot::DiagnoseError with one sentence if MuJoCo cannot load the file. Meshes that are missing are left
/// out.
RobotModel load_robot(const std::filesystem::path& file);

/// The same from a text; `folder` is where its other files are.
ModelPointer compile_model(const std::string& text, const std::filesystem::path& folder, bool urdf,
                           std::string& complaint);

}  // namespace diagnose_robot
