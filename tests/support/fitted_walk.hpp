// The walking robot's model, calibrated on recordings of one that differs.
#pragma once

#include <cstdint>
#include <utility>

#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/data_split.hpp"
#include "tests/support/walking_robot.hpp"

namespace toys {

struct FittedWalk {
  surefoot::diagnosis::BoundSimulator bound;
  surefoot::diagnosis::RecordingSplit split;
  surefoot::diagnosis::FitProblem problem;
  surefoot::diagnosis::Hypothesis hypothesis;
};

/// Forty sequences with a pose in every row, each predicted from the row before; see walk_recordings for `change`.
template <class Change>
FittedWalk fitted_walk(Change&& change, std::uint64_t seed,
                       const surefoot::diagnosis::Parallel& parallel = surefoot::diagnosis::serially()) {
  FittedWalk walk{.bound = surefoot::diagnosis::bind_simulator(WalkingRobot{}, walk_recordings(change, false, 40, seed)),
                  .split = {},
                  .problem = {},
                  .hypothesis = {}};
  walk.bound.integration.restart = 1;
  walk.split = surefoot::diagnosis::split_recordings(walk.bound.recordings, {}, 0.2, 4, seed);
  walk.problem.recordings = walk.split.training;
  walk.problem.integration = walk.bound.integration;
  walk.hypothesis = surefoot::diagnosis::calibrate(walk.bound, surefoot::diagnosis::nominal_hypothesis(walk.bound),
                                                   walk.problem, 8, seed, parallel)
                        .hypothesis;
  return walk;
}

}  // namespace toys
