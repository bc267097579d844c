#include "augmented_xml.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "augmented_header.hpp"
#include "inertial_xml.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/core/error.hpp"
#include "xml_text.hpp"

namespace diagnose_robot {
namespace {

// Dry friction of MuJoCo is a soft constraint; this hard it creeps less than any encoder sees.
constexpr double friction_impedance = 0.995;
constexpr double friction_steps = 2;  // time constant in steps, the shortest that MuJoCo allows

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

void set_joint(mjModel* m, const RobotJoint& joint, const JointPhysics& physics) {
  const int dof = joint.model.dof;
  m->dof_frictionloss[dof] = physics[Property::coulomb];
  m->dof_damping[dof] = physics[Property::viscous];
  m->dof_armature[dof] = physics[Property::armature];
  m->dof_solref[mjNREF * dof] = friction_steps * m->opt.timestep;
  m->dof_solref[mjNREF * dof + 1] = 1;
  m->dof_solimp[mjNIMP * dof] = friction_impedance;
  m->dof_solimp[mjNIMP * dof + 1] = friction_impedance;
}

// A torque limit, a position drive or a motor; explicit in everything, so that default classes change nothing.
std::string actuator(const Robot& robot, std::size_t j, const JointPhysics& p) {
  const RobotJoint& joint = robot.joints[j];
  const double gain = (1 + p[Property::torque_gain]) / (1 + p[Property::reading_scale]);
  const double kp = gain * joint.setup.kp * (1 + p[Property::kp_error]),
               kd = gain * joint.setup.kd * (1 + p[Property::kd_error]);
  const double limit = joint.setup.limit * (1 - p[Property::torque_limit]);
  std::string text = "    <general name=\"" + joint.setup.name + "_drive\" joint=\"" + joint.setup.name +
                     "\" gear=\"1 0 0 0 0 0\" ctrllimited=\"false\" dyntype=\"none\" gaintype=\"fixed\"";
  if (robot.setup.drive == DriveKind::position) {
    text += " biastype=\"affine\" gainprm=\"" + number(kp) + " 0 0\" biasprm=\"" +
            number(p[Property::constant_torque] - kp * p[Property::sensor_bias]) + " " + number(-kp) + " " +
            number(-kd) + "\"";
  } else {
    text += " biastype=\"affine\" gainprm=\"" + number(gain) + " 0 0\" biasprm=\"" +
            number(p[Property::constant_torque]) + " 0 0\"";
  }
  if (limit > 0) text += " forcelimited=\"true\" forcerange=\"" + number(-limit) + " " + number(limit) + "\"";
  return text + "/>\n";
}

std::string with_actuators(std::string xml, const Robot& robot, const RobotPhysics& physics) {
  std::string section = "<actuator>\n";
  for (std::size_t j = 0; j < robot.joints.size(); ++j) section += actuator(robot, j, physics[j]);
  section += "  </actuator>\n";
  xml = without_elements(xml, {"actuator", "keyframe", "sensor"});  // sensors may name actuators that are gone
  const std::size_t end = xml.rfind("</mujoco>");
  if (end == std::string::npos)
    throw surefoot::DiagnoseError("MuJoCo wrote no model; choose another folder with --out");
  return xml.insert(end, "  " + section);
}

// What of it MuJoCo's format has a place for.
std::string place_in_mjcf(Property p) {
  switch (p) {
    case Property::coulomb:
      return "joint frictionloss";
    case Property::viscous:
      return "joint damping";
    case Property::armature:
      return "joint armature";
    case Property::kp_error:
      return "actuator gainprm, biasprm";
    case Property::kd_error:
      return "actuator biasprm";
    case Property::reading_scale:
      return "actuator gainprm";
    case Property::torque_gain:
      return "actuator gainprm, biasprm";
    case Property::torque_limit:
      return "actuator forcerange";
    case Property::constant_torque:
      return "actuator biasprm";
    case Property::stiffness:
      return "joint stiffness, added";
    case Property::sensor_bias:
      return "actuator biasprm; subtract it from readings";
    case Property::link_mass:
    case Property::link_inertia:
      return "body inertial mass, inertia";
    case Property::link_com_x:
    case Property::link_com_y:
    case Property::link_com_z:
      return "body inertial pos";
    case Property::goal_clock:
      return "nowhere: of the log";
    case Property::payload:
      return "body inertial mass, pos, inertia";
    default:
      return "augmented.hpp";
  }
}

std::vector<AugmentedEntry> table_of(const Robot& robot, const RobotPhysics& physics) {
  std::vector<AugmentedEntry> table;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    for (const PropertyInfo& info : property_table()) {
      const double value = physics[j][info.property], in_file = robot.nominal[j][info.property];
      if (value == 0 && in_file == 0) continue;
      Term term;
      term.property = info.property;
      term.joints = {static_cast<int>(j)};
      table.push_back({robot.joints[j].setup.name, info.effect, info.parameter, unit_of(robot, term), value, in_file,
                       place_in_mjcf(info.property)});
    }
  }
  return table;
}

std::string saved(const mjModel* model) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("surefoot_" + std::to_string(getpid()) + ".xml");
  std::array<char, 1000> error{};
  const int written = mj_saveLastXML(file.string().c_str(), model, error.data(), static_cast<int>(error.size()));
  std::string text;
  if (written != 0) {
    const surefoot::Bytes bytes = surefoot::read_file(file);
    text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  std::error_code none;
  std::filesystem::remove(file, none);
  if (text.empty())
    throw surefoot::DiagnoseError(std::string("MuJoCo cannot write the corrected model: ") + error.data());
  return text;
}

}  // namespace

AugmentedModel augmented_model(const Robot& robot, const RobotPhysics& physics, double step,
                               const std::filesystem::path& folder, int integrator) {
  std::string complaint;
  const ModelPointer last =
      compile_model(robot.model.text, folder, is_urdf(robot.model.text), complaint);  // what is saved next
  if (!last) throw surefoot::DiagnoseError(robot.model.file + ": MuJoCo cannot load it again: " + complaint);
  const ModelPointer changed = model_with_bodies(robot, physics);
  mjModel* m = changed.get();
  for (int dof = 0; dof < m->nv; ++dof) {  // of joints that were held: as in the file
    m->dof_frictionloss[dof] = last->dof_frictionloss[dof];
    m->dof_damping[dof] = last->dof_damping[dof];
    m->dof_armature[dof] = last->dof_armature[dof];
  }
  m->opt.timestep = step;
  m->opt.integrator = integrator;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) set_joint(m, robot.joints[j], physics[j]);
  AugmentedModel augmented;
  std::string xml = saved(m);
  if (std::ranges::any_of(physics, changes_bodies)) xml = with_inertials(xml, m);
  augmented.xml = with_actuators(std::move(xml), robot, physics);
  augmented.header = augmented_header(robot, physics);
  augmented.table = table_of(robot, physics);
  return augmented;
}

}  // namespace diagnose_robot
