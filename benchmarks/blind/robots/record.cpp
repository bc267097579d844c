#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "robot_case.hpp"
#include "text.hpp"

namespace blind_robots {
namespace {

constexpr double settle = 1;  // [s]

/// Where a joint is sent: a few sines about a posture.
struct Goal {
  double middle = 0;
  std::array<double, 3> amplitude{}, frequency{}, phase{};

  Goal(plants::Random& random) : middle(random.uniform(-0.4, 0.4)) {
    for (std::size_t i = 0; i < 3; ++i) {
      amplitude[i] = random.uniform(0.08, 0.3);
      frequency[i] = random.log_uniform(0.15, 1.5);
      phase[i] = random.uniform(0, 2 * std::numbers::pi);
    }
  }

  double operator()(double t) const {
    double sum = middle;
    for (std::size_t i = 0; i < 3; ++i)
      sum += amplitude[i] * std::sin(2 * std::numbers::pi * frequency[i] * t + phase[i]);
    return sum;
  }
};

mjModel* compile(const std::string& xml) {
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "robot.xml", static_cast<int>(xml.size()));
  std::copy(xml.begin(), xml.end(), static_cast<char*>(files->filedata[0]));
  char error[500] = "";
  mjModel* model = mj_loadXML("robot.xml", files.get(), error, sizeof error);
  mj_deleteVFS(files.get());
  if (model == nullptr) throw std::runtime_error(error);
  return model;
}

}  // namespace

std::string record(const RobotCase& robot, plants::Random& random, const RecordingLength& length) {
  const std::unique_ptr<mjModel, void (*)(mjModel*)> model(compile(robot_xml(robot, true)), mj_deleteModel);
  mjModel* m = model.get();
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(m), mj_deleteData);
  mjData* d = data.get();
  const std::size_t n = robot.joints.size();
  std::vector<Goal> goals(n, Goal(random));
  for (Goal& goal : goals) goal = Goal(random);
  std::vector<int> at(n);
  std::vector<std::deque<double>> told(n);
  std::vector<double> seen(n), torque(n);
  for (std::size_t j = 0; j < n; ++j) {
    at[j] = m->jnt_qposadr[mj_name2id(m, mjOBJ_JOINT, robot.joints[j].name.c_str())];
    seen[j] = d->qpos[at[j]] = goals[j](0);
  }
  const double noise = random.uniform(5e-5, 3e-4);  // [rad]
  std::string text = "t_s";
  for (const Joint& joint : robot.joints)
    text += robot.torque_driven ? ",torque_" + joint.name + "_N_m" : ",goal_" + joint.name + "_rad";
  for (const Joint& joint : robot.joints) text += "," + joint.name + "_rad";
  text += "\n";
  const auto steps_per_row = static_cast<int>(std::lround(length.row_period / m->opt.timestep));
  const auto before = static_cast<int>(std::lround(settle / length.row_period));
  const auto rows = static_cast<int>(std::lround(length.seconds / length.row_period));
  for (int row = -before; row < rows; ++row) {
    const double t = row * length.row_period;
    std::vector<double> goal(n), reading(n);
    for (std::size_t j = 0; j < n; ++j) {
      goal[j] = goals[j](std::max(0.0, t));
      reading[j] = d->qpos[at[j]] + robot.joints[j].hidden.bias + random.normal(noise);
    }
    for (const auto& [a, b] : robot.swapped) std::swap(reading[a], reading[b]);
    std::vector<double> told_torque(n, 0.0);
    for (int step = 0; step < steps_per_row; ++step) {
      for (std::size_t j = 0; j < n; ++j) {
        const Joint& joint = robot.joints[j];
        const HiddenJoint& hidden = joint.hidden;
        // Torques that are logged come from a controller whose goals are not: it moves them at every step.
        const double within = static_cast<double>(step) * m->opt.timestep;
        told[j].push_back(robot.torque_driven && t >= 0 ? goals[j](t + within) : goal[j]);
        const auto late = static_cast<std::size_t>(std::lround(hidden.delay / m->opt.timestep));
        while (told[j].size() > late + 1) told[j].pop_front();
        const double q = d->qpos[at[j]], v = d->qvel[at[j]];
        seen[j] = std::clamp(seen[j], q - hidden.backlash, q + hidden.backlash);
        const double limit = joint.limit * (1 - hidden.missing_limit);
        torque[j] = joint.kp * (told[j].front() - seen[j] - hidden.bias) - joint.kd * v;
        if (step == 0) told_torque[j] = torque[j];
        const double given = std::clamp((1 - hidden.weakness) * torque[j], -limit, limit);
        d->qfrc_applied[at[j]] = given;
        m->dof_frictionloss[at[j]] = hidden.coulomb + hidden.load_friction * std::abs(given);
      }
      mj_step(m, d);
    }
    if (row < 0) continue;
    text += plants::text(t, "%.4f");
    for (std::size_t j = 0; j < n; ++j)
      text += "," + plants::text(robot.torque_driven ? told_torque[j] : goal[j], "%.7g");
    for (std::size_t j = 0; j < n; ++j) text += "," + plants::text(reading[j], "%.7g");
    text += "\n";
  }
  return text;
}

}  // namespace blind_robots
