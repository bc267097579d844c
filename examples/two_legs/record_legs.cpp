// record_legs: stands for the real pair of legs, on its stand, and for the computer that logs it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "legs.hpp"

namespace {

const std::array<std::string, 6> joints{"left_hip_roll",  "left_hip_pitch",  "left_knee",
                                        "right_hip_roll", "right_hip_pitch", "right_knee"};
constexpr double step = 0.00025, row = 0.005, seconds = 8;  // [s]
constexpr double noise = 2e-4;                              // [rad]

// [hidden]
// What the real legs have and legs.xml does not.
constexpr double late = 0.012;  // [s]: every goal waits on the bus
constexpr double knee_friction = 0.2,
                 worn_knee = 0.4;  // [N m]: both knees; the left one, whose bearing is worn, has more
// [hidden]

void add_friction(mjModel* m, int dof, double torque) {
  m->dof_frictionloss[dof] = torque;
  m->dof_solref[mjNREF * dof] = 8 * step;  // stiffer than by default: it must not creep
  m->dof_solimp[mjNIMP * dof] = 0.98;
  m->dof_solimp[mjNIMP * dof + 1] = 0.99;
}

// Slow and far, then faster and less far, about a posture with bent knees.
double goal(std::size_t joint, int recording, double t) {
  const bool knee = joint % 3 == 2, roll = joint % 3 == 0;
  const double middle = knee ? 1.0 : roll ? 0.0 : -0.4, reach = roll ? 0.25 : 0.5;
  const double pace = 0.35 + 0.13 * static_cast<double>(joint) + 0.2 * recording,
               phase = static_cast<double>(joint) + recording;
  const double turn = 2 * std::numbers::pi * t;
  return middle + reach * (0.6 * std::sin(pace * turn + phase) + 0.25 * std::sin(3.1 * pace * turn + 2 * phase));
}

void record(const std::string& model, const std::string& file, int recording) {
  two_legs::Simulation real(model);
  mjModel* m = real.model.get();
  mjData* d = real.data.get();
  m->opt.timestep = step;
  add_friction(m, real.dof("left_knee"), knee_friction + worn_knee);
  add_friction(m, real.dof("right_knee"), knee_friction);
  for (std::size_t j = 0; j < joints.size(); ++j) d->qpos[real.position(joints[j])] = goal(j, recording, 0);

  std::ofstream log(file);
  log << "t_s";
  for (const std::string& joint : joints) log << ",goal_" << joint << "_rad";
  for (const std::string& joint : joints) log << ',' << joint << "_rad";
  log << '\n';
  std::mt19937 random(static_cast<unsigned>(recording));
  std::normal_distribution<double> error(0, noise);
  constexpr double settle = 1;  // [s] before the log begins
  constexpr int steps = static_cast<int>(row / step + 0.5), rows = static_cast<int>((settle + seconds) / row + 0.5),
                before = static_cast<int>(settle / row + 0.5);
  for (int k = 0; k < rows; ++k) {
    const double t = (k - before) * row;
    if (k >= before) {
      log << t;
      for (std::size_t j = 0; j < joints.size(); ++j) log << ',' << goal(j, recording, std::max(0.0, t));
      for (const std::string& joint : joints) log << ',' << d->qpos[real.position(joint)] + error(random);
      log << '\n';
    }
    for (int i = 0; i < steps; ++i) {
      // The drives get a new goal with every row, late.
      const double told = std::floor((t + i * step - late) / row + 1e-9) * row;
      for (std::size_t j = 0; j < joints.size(); ++j) d->ctrl[j] = goal(j, recording, std::max(0.0, told));
      mj_step(m, d);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: record_legs legs.xml FOLDER: writes log_1.csv to log_3.csv\n";
    return 2;
  }
  try {
    for (int recording = 1; recording <= 3; ++recording)
      record(argv[1], std::string(argv[2]) + "/log_" + std::to_string(recording) + ".csv", recording);
  } catch (const std::exception& error) {
    std::cerr << "record_legs: " << error.what() << '\n';
    return 1;
  }
}
