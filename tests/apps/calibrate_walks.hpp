// Walks and motion files for the tests of surefoot-calibrate.
#pragma once

#include <string>

#include "apps/calibrate/fit_walk.hpp"
#include "apps/calibrate/paper_robot.hpp"
#include "apps/calibrate/walk_csv.hpp"
#include "surefoot/motion/plan.hpp"
#include "surefoot/motion/simulate_walk.hpp"
#include "tests/support/program.hpp"

namespace calibrate_test {

inline std::vector<surefoot::WalkSequence> paper_walks(int count, int cycles, bool every_pose, std::uint64_t seed = 1) {
  const calibrate_program::MotionFile robot = calibrate_program::paper_robot();
  std::vector<surefoot::WalkSequence> walks;
  for (const auto& commands : surefoot::plan_commands(surefoot::CommandBounds(), count, cycles, seed)) {
    surefoot::Rng rng(seed, walks.size(), 7);
    walks.push_back(simulate_walk(robot.model, robot.noise, surefoot::PoseAccuracy(),
                                  surefoot::planned_sequence(commands, every_pose), rng));
    walks.back().name = std::to_string(walks.size());
  }
  return walks;
}

inline calibrate_program::StoppableThreads two_threads() { return {surefoot::Threads(2)}; }

/// A motion file with nothing left out.
inline calibrate_program::MotionFile rich_file() {
  calibrate_program::MotionFile file = calibrate_program::paper_robot();
  file.covariance.setIdentity();
  file.covariance *= 1e-4;
  file.covariance(0, 1) = file.covariance(1, 0) = 3e-5;
  file.noise.per_speed << 0.001, 0.002, 0.003;
  file.accuracy = {.position = 0.01, .heading = 0.05, .heading_tolerance = 0.25};
  file.steps_per_cycle = 2;
  file.method = "likelihood";
  file.sequences = 25;
  file.readings = 75;
  file.seed = 4;
  file.heldout = {{.model = "commands as they are", .position = 0.39, .position_error = 0.04, .heading = 0.3},
                  {.model = "full linear", .parameters = 12, .position = 0.26, .chosen = true}};
  file.test = {{.model = "full linear", .parameters = 12, .position = 0.27}};
  return file;
}

inline approach_program::Outcome calibrate(const std::string& arguments) {
  return approach_program::run_command(SUREFOOT_BIN_DIR "/surefoot-calibrate " + arguments);
}

}  // namespace calibrate_test
