// The walking robot's model, calibrated on recordings of one that differs.
#pragma once

#include <cstdint>
#include <utility>

#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/data_split.hpp"
#include "tests/support/walking_robot.hpp"

namespace toys {

struct FittedWalk {
  surefoot::BoundSimulator rig;
  surefoot::RecordingSplit split;
  surefoot::FitProblem problem;
  surefoot::Hypothesis hypothesis;
};

/// Forty sequences with a pose in every row, each predicted from the row before; see walk_recordings for `change`.
template <class Change>
FittedWalk fitted_walk(Change&& change, std::uint64_t seed, const surefoot::Parallel& parallel = surefoot::serially()) {
  FittedWalk walk{.rig = surefoot::bind_simulator(WalkingRobot{}, walk_recordings(change, false, 40, seed)),
                  .split = {},
                  .problem = {},
                  .hypothesis = {}};
  walk.rig.integration.restart = 1;
  walk.split = surefoot::split_recordings(walk.rig.recordings, {}, 0.2, 4, seed);
  walk.problem.recordings = walk.split.training;
  walk.problem.integration = walk.rig.integration;
  walk.hypothesis =
      surefoot::calibrate(walk.rig, surefoot::nominal_hypothesis(walk.rig), walk.problem, 8, seed, parallel).hypothesis;
  return walk;
}

}  // namespace toys
