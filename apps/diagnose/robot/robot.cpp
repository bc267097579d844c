#include "robot.hpp"

#include <algorithm>
#include <cmath>

#include "../names.hpp"
#include "../wording.hpp"
#include "surefoot/core/error.hpp"

namespace diagnose_robot {
namespace {

using diagnose_program::in_quotes;
using surefoot::DiagnoseError;

constexpr double contact_share = 0.05;      // of the rows that may touch something: a landing or a knock
constexpr Eigen::Index contact_rows = 200;  // rows looked at
constexpr double degrees_factor = 4;        // so far beyond the range of a joint no angle in radians is

void place_joints(const RobotSetup& setup, Robot& robot) {
  std::vector<std::string> names;
  for (const ModelJoint& joint : robot.model.joints) names.push_back(joint.name);
  for (const JointSetup& joint : setup.joints) {
    const auto found = std::ranges::find(robot.model.joints, joint.name, &ModelJoint::name);
    if (found == robot.model.joints.end()) {
      if (mj_name2id(robot.model.model.get(), mjOBJ_JOINT, joint.name.c_str()) >= 0) {
        throw DiagnoseError(setup.file + ", [joints]: " + in_quotes(joint.name) + " of " + robot.model.file +
                            " is a ball or a free joint; only hinges and slides can be diagnosed: take its table out");
      }
      throw DiagnoseError(setup.file + ", [joints]: " + robot.model.file + " has no joint " + in_quotes(joint.name) +
                          diagnose_program::suggestion(joint.name, names));
    }
    robot.joints.push_back({*found, joint, 0, -1, 0});
    JointSetup& own = robot.joints.back().setup;
    if (own.limit == 0) own.limit = found->torque_limit;
    robot.joint_of_dof[static_cast<std::size_t>(found->dof)] = static_cast<int>(robot.joints.size()) - 1;
  }
  std::vector<std::string> missing;
  for (const ModelJoint& joint : robot.model.joints) {
    const bool known = robot.joint_of_dof[static_cast<std::size_t>(joint.dof)] >= 0 ||
                       std::ranges::find(setup.held, joint.name) != setup.held.end();
    if (!known) missing.push_back(joint.name);
  }
  if (!missing.empty()) {
    throw DiagnoseError(setup.file + ": no columns for the joint(s) " + diagnose_program::listed(missing) +
                        "; name their columns under [joints], or list them under held if they did not move");
  }
  for (const std::string& name : setup.held) {
    if (std::ranges::find(names, name) == names.end()) {
      throw DiagnoseError(setup.file + ", held: " + robot.model.file + " has no joint " + in_quotes(name) +
                          diagnose_program::suggestion(name, names));
    }
  }
}

void find_trees(Robot& robot) {
  const mjModel* m = robot.model.model.get();
  robot.trees = 0;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    RobotJoint& joint = robot.joints[j];
    for (int dof = m->dof_parentid[joint.model.dof]; dof >= 0 && joint.before < 0; dof = m->dof_parentid[dof]) {
      joint.before = robot.joint_of_dof[static_cast<std::size_t>(dof)];
    }
  }
  std::vector<int> root(robot.joints.size()), tree(robot.joints.size(), -1);
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    int at = static_cast<int>(j);
    while (robot.joints[static_cast<std::size_t>(at)].before >= 0)
      at = robot.joints[static_cast<std::size_t>(at)].before;
    root[j] = at;
    int& number = tree[static_cast<std::size_t>(at)];
    if (number < 0) number = robot.trees++;
    robot.joints[j].tree = number;
  }
}

// Mass, centre and inertia of a link with a change and a point mass; the principal axes turn with it.
void change_body(mjModel* m, const ModelJoint& joint, const JointPhysics& physics) {
  const int b = joint.body;
  const double scale = std::max(0.05, 1 + physics[Property::link_mass]);
  mjtNum* position = m->body_ipos + 3 * b;
  mjtNum* inertia = m->body_inertia + 3 * b;
  m->body_mass[b] *= scale;
  for (int i = 0; i < 3; ++i) inertia[i] *= scale * std::max(0.05, 1 + physics[Property::link_inertia]);
  position[0] += physics[Property::link_com_x];
  position[1] += physics[Property::link_com_y];
  position[2] += physics[Property::link_com_z];
  const double added = physics[Property::payload];
  if (added == 0) return;
  const double mass = m->body_mass[b] + added;
  mjtNum axes[9], full[9] = {0}, arm[3];
  mju_quat2Mat(axes, m->body_iquat + 4 * b);
  for (int i = 0; i < 3; ++i) {
    arm[i] = joint.tip[i] - position[i];
    for (int r = 0; r < 9; ++r) full[r] += axes[3 * (r / 3) + i] * inertia[i] * axes[3 * (r % 3) + i];
  }
  const double reduced = added * m->body_mass[b] / mass, square = mju_dot3(arm, arm);
  for (int r = 0; r < 9; ++r) full[r] += reduced * ((r / 3 == r % 3 ? square : 0) - arm[r / 3] * arm[r % 3]);
  mjtNum vectors[9];
  mju_eig3(inertia, vectors, m->body_iquat + 4 * b, full);
  for (int i = 0; i < 3; ++i) position[i] += added / mass * arm[i];
  m->body_mass[b] = mass;
}

// Share of the rows in which the joint is at the end of its range or beyond.
double share_at_stops(const ModelJoint& joint, const Eigen::Ref<const Eigen::VectorXd>& angle) {
  if (!(joint.high > joint.low)) return 0;
  return static_cast<double>((angle.array() <= joint.low || angle.array() >= joint.high).count()) /
         static_cast<double>(angle.size());
}

void refuse_stops(const Robot& robot, const RobotRecording& recording) {
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const RobotJoint& joint = robot.joints[j];
    const double share = share_at_stops(joint.model, recording.angle.col(static_cast<Eigen::Index>(j)));
    if (share <= contact_share) continue;
    const std::string unit = joint.model.slides ? " m" : " rad";
    throw DiagnoseError(
        recording.name + ": in " + diagnose_program::percent(share) + " of the rows " + in_quotes(joint.setup.name) +
        " is at a stop or beyond (" + robot.model.file + " has " + diagnose_program::rounded(joint.model.low) + " to " +
        diagnose_program::rounded(joint.model.high) + unit +
        "); stops are not diagnosed: mend the range, which MJCF takes for degrees unless it says <compiler "
        "angle=\"radian\"/>, record away from the stop, or write contacts = \"ignore\" in " +
        robot.setup.file);
  }
}

}  // namespace

bool changes_bodies(const JointPhysics& joint) {
  return std::ranges::any_of(property_table(), [&](const PropertyInfo& info) {
    return is_of_body(info.property) && joint[info.property] != 0;
  });
}

ModelPointer model_with_bodies(const Robot& robot, const RobotPhysics& physics) {
  ModelPointer model(mj_copyModel(nullptr, robot.model.model.get()));
  mjModel* m = model.get();
  mju_zero(m->dof_armature, m->nv);
  mju_zero(m->dof_damping, m->nv);
  mju_zero(m->dof_frictionloss, m->nv);
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    if (changes_bodies(physics[j])) change_body(m, robot.joints[j].model, physics[j]);
    m->jnt_stiffness[robot.joints[j].model.id] += physics[j][Property::stiffness];
  }
  return model;
}

double rest_of_spring(const Robot& robot, std::size_t joint) {
  return robot.model.model->qpos_spring[robot.joints[joint].model.position];
}

Robot bind_robot(RobotModel model, const RobotSetup& setup) {
  Robot robot;
  robot.model = std::move(model);
  robot.setup = setup;
  mjModel* m = robot.model.model.get();
  robot.joint_of_dof.assign(static_cast<std::size_t>(m->nv), -1);
  place_joints(setup, robot);
  if (robot.model.floating_base && !setup.base_held) {
    throw DiagnoseError(robot.model.file +
                        ": the base floats; if it was held in the recordings write base = \"held\" in " + setup.file +
                        ", and if it was not, record with the robot hanging or clamped");
  }
  if (setup.gravity) std::copy_n(setup.gravity->data(), 3, m->opt.gravity);
  find_trees(robot);
  for (std::size_t g = 0; g < setup.groups.size(); ++g) {
    robot.groups.emplace_back();
    for (const std::string& name : setup.groups[g].joints) {
      const auto found =
          std::ranges::find_if(robot.joints, [&](const RobotJoint& joint) { return joint.setup.name == name; });
      found->group = static_cast<int>(g);
      robot.groups.back().push_back(static_cast<int>(found - robot.joints.begin()));
    }
  }
  robot.nominal.resize(robot.joints.size());
  for (std::size_t j = 0; j < robot.joints.size() && setup.from_model; ++j) {
    robot.nominal[j][Property::viscous] = robot.joints[j].model.damping;
    robot.nominal[j][Property::armature] = robot.joints[j].model.armature;
    robot.nominal[j][Property::coulomb] = robot.joints[j].model.frictionloss;
  }
  return robot;
}

std::vector<std::string> check_recording(const Robot& robot, const RobotRecording& recording) {
  const mjModel* m = robot.model.model.get();
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const RobotJoint& joint = robot.joints[j];
    const double reach = recording.angle.col(static_cast<Eigen::Index>(j)).cwiseAbs().maxCoeff();
    const double range = std::max(std::abs(joint.model.low), std::abs(joint.model.high));
    if (joint.model.slides || range == 0 || reach < degrees_factor * range || reach < degrees_factor) continue;
    throw DiagnoseError(recording.name + ": " + in_quotes(joint.setup.angle.name) + " reaches " +
                        diagnose_program::rounded(reach) + ", but " + in_quotes(joint.setup.name) + " moves to " +
                        diagnose_program::rounded(range) + " rad; if these are degrees, write angle = { column = \"" +
                        joint.setup.angle.name + "\", unit = \"deg\" }");
  }
  if (!robot.setup.ignore_contacts) refuse_stops(robot, recording);
  const DataPointer data(mj_makeData(m));
  const Eigen::Index rows = recording.time.size(), stride = std::max<Eigen::Index>(1, rows / contact_rows);
  Eigen::Index looked = 0, touching = 0;
  std::string pair;
  for (Eigen::Index k = 0; k < rows; k += stride, ++looked) {
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      data->qpos[robot.joints[j].model.position] = recording.angle(k, static_cast<Eigen::Index>(j));
    }
    mj_kinematics(m, data.get());
    mj_comPos(m, data.get());
    mj_collision(m, data.get());
    for (int c = 0; c < data->ncon; ++c) {
      const mjContact& contact = data->contact[c];
      const int a = m->geom_bodyid[contact.geom1], b = m->geom_bodyid[contact.geom2];
      if (contact.dist >= 0 || (a != 0 && b != 0)) continue;
      const char* name = mj_id2name(m, mjOBJ_BODY, std::max(a, b));
      pair = name != nullptr ? name : "a link";
      ++touching;
      break;
    }
  }
  if (robot.setup.ignore_contacts || static_cast<double>(touching) <= contact_share * static_cast<double>(looked))
    return {};
  throw DiagnoseError(
      recording.name + ": in " +
      diagnose_program::percent(static_cast<double>(touching) / static_cast<double>(looked)) + " of the rows " +
      in_quotes(pair) +
      " touches the world; contacts are not diagnosed: record in the air, or write contacts = \"ignore\" in " +
      robot.setup.file);
}

}  // namespace diagnose_robot
