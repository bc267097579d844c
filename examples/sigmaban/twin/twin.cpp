#include "twin.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <string>

#include "mjcf.hpp"

namespace sigmaban {
namespace {

/// MuJoCo would write a log file into the working folder; what matters of its warnings is counted in mjData.
void ignore_warning(const char* /*message*/) {}

mjModel* compile(const std::string& xml) {
  static std::mutex one_at_a_time;  // MuJoCo's compiler has global state
  const std::scoped_lock lock(one_at_a_time);
  if (mju_user_warning == nullptr) mju_user_warning = ignore_warning;
  constexpr const char* file = "twin.xml";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), file, static_cast<int>(xml.size())) != 0) {
    throw TwinError("the twin's model does not fit into MuJoCo's memory, make it smaller");
  }
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), file)], xml.data(), xml.size());
  std::array<char, 1000> complaint{};
  mjModel* model = mj_loadXML(file, files.get(), complaint.data(), static_cast<int>(complaint.size()));
  mj_deleteVFS(files.get());
  if (model == nullptr) {
    throw TwinError(std::string("MuJoCo refuses the twin's parameters, change them: ") + complaint.data());
  }
  return model;
}

int id(const mjModel* model, mjtObj kind, const std::string& name) {
  return mj_name2id(model, static_cast<int>(kind), name.c_str());
}

}  // namespace

void Twin::Free::operator()(mjModel_* model) const { mj_deleteModel(model); }
void Twin::Free::operator()(mjData_* data) const { mj_deleteData(data); }

Twin::Twin(const TwinParameters& parameters, const TwinSwitches& switches)
    : parameters_(parameters), switches_(switches) {
  check(switches);
  const double steps = parameters.order_period / parameters.time_step;
  if (!(steps >= 0.5) || std::abs(steps - std::round(steps)) > 1e-6) {
    throw TwinError("TwinParameters: order_period must be a multiple of time_step");
  }
  steps_per_order_ = static_cast<int>(std::lround(steps));
  model_.reset(compile(mjcf(parameters, switches)));
  data_.reset(mj_makeData(model_.get()));
  const mjModel* m = model_.get();
  trunk_ = id(m, mjOBJ_BODY, "trunk");
  for (std::size_t i = 0; i < 12; ++i) {
    position_[i] = m->jnt_qposadr[id(m, mjOBJ_JOINT, std::string(joint_names[i]))];
  }
  std::size_t cleat = 0;
  for (const std::string side : {"left", "right"}) {
    foot_[cleat / 4] = id(m, mjOBJ_BODY, side + "_foot");
    for (int i = 1; i <= 4; ++i) cleat_[cleat++] = id(m, mjOBJ_GEOM, side + "_cleat_" + std::to_string(i));
  }
  reset({});
}

void Twin::reset(const JointTargets& stand) {
  const mjModel* m = model_.get();
  mjData* d = data_.get();
  mj_resetData(m, d);
  const auto targets = stand.array();
  for (std::size_t i = 0; i < 12; ++i) {
    d->qpos[position_[i]] = targets[i] + zero(i);
    d->ctrl[i] = targets[i] + zero(i);
  }
  // The free joint's seven coordinates come first: position, then orientation as a quaternion.
  mj_kinematics(m, d);
  mju_negQuat(d->qpos + 3, d->xquat + 4 * foot_[0]);
  mj_kinematics(m, d);
  double lowest = mjMAXVAL;
  for (const int cleat : cleat_) {
    lowest = std::min(lowest, d->geom_xpos[3 * cleat + 2] - parameters_.cleats.radius);
  }
  d->qpos[2] -= lowest;
  set_frictions();
  mj_forward(m, d);
  reading_ = {};
}

void Twin::drive(const JointTargets& targets) {
  if (!all_finite(targets)) throw TwinError("Twin::drive: a joint target is not finite");
  const auto angles = targets.array();
  for (std::size_t i = 0; i < 12; ++i) data_->ctrl[i] = angles[i] + zero(i);
  using surefoot::Vec;
  const Vec<3> velocity = Vec<3>::Map(data_->qvel);
  reading_ = {};
  for (int i = 0; i < steps_per_order_; ++i) {
    set_frictions();
    mj_step(model_.get(), data_.get());
    reading_.gyro += Vec<3>::Map(data_->qvel + 3) / steps_per_order_;  // of a free joint: in the body's frame
    add_loads();
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (reading_.loads[side] > 0) reading_.pressure_x[side] /= reading_.loads[side];
  }
  const Vec<3> acceleration = (Vec<3>::Map(data_->qvel) - velocity) / parameters_.order_period;
  const Vec<3> felt = acceleration - gravity();
  mju_rotVecMatT(reading_.accelerometer.data(), felt.data(), data_->xmat + 9 * trunk_);
}

void Twin::push(const surefoot::Vec<3>& force) { mju_copy3(data_->xfrc_applied + 6 * trunk_, force.data()); }

void Twin::add_loads() {
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    if (contact.efc_address < 0) continue;
    const int cleat = std::max(contact.geom1, contact.geom2);  // the ground comes first
    const std::size_t side = cleat >= cleat_[4] ? 1 : 0;
    const double load = data_->efc_force[contact.efc_address] / steps_per_order_;  // of elliptic cones: the normal
    const bool front = (cleat - cleat_[4 * side]) < 2;
    reading_.loads[side] += load;
    reading_.pressure_x[side] += load * (front ? parameters_.cleats.x : -parameters_.cleats.x);
  }
}

void Twin::set_frictions() {
  if (switches_.slippery_radius <= 0) return;
  for (const int cleat : cleat_) {
    const double x = data_->geom_xpos[3 * cleat] - slippery_centre, y = data_->geom_xpos[3 * cleat + 1];
    const bool slips = x * x + y * y < switches_.slippery_radius * switches_.slippery_radius;
    model_->geom_friction[3 * cleat] = slips ? slippery_friction : parameters_.contact.friction;
  }
}

surefoot::Pose2 Twin::pose() const {
  const mjtNum* axes = data_->xmat + 9 * trunk_;  // row by row
  return {data_->qpos[0], data_->qpos[1], std::atan2(axes[3], axes[0])};
}

double Twin::height() const { return data_->qpos[2]; }

bool Twin::fallen() const {
  constexpr double cosine = 0.70710678118654752;
  const auto failed = [&](mjtWarning warning) { return data_->warning[warning].number > 0; };
  return !(data_->xmat[9 * trunk_ + 8] > cosine) || failed(mjWARN_BADQPOS) || failed(mjWARN_BADQVEL) ||
         failed(mjWARN_BADQACC);
}

std::array<double, 12> Twin::joint_positions() const {
  std::array<double, 12> result{};
  for (std::size_t i = 0; i < 12; ++i) result[i] = data_->qpos[position_[i]] - zero(i);
  return result;
}

std::array<double, 12> Twin::joint_goals() const {
  std::array<double, 12> result{};
  for (std::size_t i = 0; i < 12; ++i) result[i] = data_->ctrl[i] - zero(i);
  return result;
}

std::array<double, 12> Twin::joint_currents() const {
  const dynamixel::MotorParameters motor;
  const double back_emf_damping = motor.torque_constant * motor.torque_constant / motor.resistance_ohm;
  std::array<double, 12> result{};
  for (std::size_t i = 0; i < 12; ++i) {
    const double speed = data_->qvel[model_->jnt_dofadr[model_->actuator_trnid[2 * i]]];
    result[i] = (data_->actuator_force[i] - back_emf_damping * speed) / motor.torque_constant;
  }
  return result;
}

std::array<double, 12> Twin::joint_torques() const {
  std::array<double, 12> result{};
  std::copy_n(data_->actuator_force, 12, result.begin());
  return result;
}

std::array<surefoot::Vec<3>, 2> Twin::soles() const {
  std::array<surefoot::Vec<3>, 2> result;
  for (std::size_t side = 0; side < 2; ++side) {
    result[side] = {0, 0, -parameters_.cleats.radius};
    for (std::size_t i = 0; i < 4; ++i) {
      result[side] += surefoot::Vec<3>::Map(data_->geom_xpos + 3 * cleat_[4 * side + i]) / 4;
    }
  }
  return result;
}

double Twin::mass() const { return mj_getTotalmass(model_.get()); }

surefoot::Vec<3> Twin::gravity() const { return surefoot::Vec<3>::Map(model_->opt.gravity); }

double Twin::time() const { return data_->time; }

}  // namespace sigmaban
