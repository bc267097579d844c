#include "surefoot/diagnose/residual_tests/walking/sequence_residual.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/diagnose/estimation/data_split.hpp"
#include "surefoot/diagnose/estimation/noise_regime.hpp"
#include "tests/support/walking_robot.hpp"

namespace surefoot::diagnosis {
namespace {

template <class Change>
Comparison structure_of(Change&& change, std::uint64_t seed) {
  BoundSimulator bound = bind_simulator(toys::WalkingRobot{}, toys::walk_recordings(change, true, 60, seed));
  const auto split = split_recordings(bound.recordings, {}, 0.2, 4, seed);
  FitProblem problem;
  problem.recordings = split.training;
  const auto parallel = serially();
  Fit fitted = calibrate(bound, nominal_hypothesis(bound), problem, 8, seed, parallel);
  problem.weighting.whitening = final_pose_whitening(bound, fitted.hypothesis, split.training, bound.integration);
  fitted = fit(bound, fitted.hypothesis, problem, parallel);
  return sequence_structure(bound, fitted.hypothesis, problem, split.folds, parallel);
}

TEST_CASE("errors of a walk that obeys its model cannot be predicted") {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto found = structure_of([](Pose2 moved, Pose2) { return moved; }, seed);
    alarms += found.p_value < 0.005 ? 1 : 0;
  }
  CHECK(alarms <= 1);
}

TEST_CASE("errors that depend on the orders can be predicted") {
  const auto stumble = [](Pose2 moved, Pose2) {
    return Pose2{moved.x, moved.y, moved.angle + (moved.x > 0.03 ? 0.05 : 0.0)};
  };
  const auto found = structure_of(stumble, 3);
  CHECK(found.gain > 0.05);
  CHECK(found.p_value < 0.005);
}

TEST_CASE("errors that depend on the heading can be predicted") {
  const auto twist = [](Pose2 moved, Pose2 at) {
    return Pose2{moved.x, moved.y, moved.angle + 0.06 * std::sin(2 * at.angle)};
  };
  CHECK(structure_of(twist, 4).p_value < 0.005);
}

TEST_CASE("a patch of slippery floor can be predicted, though orders go to all sides") {
  const auto slip = [](Pose2 moved, Pose2 at) {
    const double hold = std::hypot(at.x - 0.1, at.y) < 0.12 ? 0.3 : 1;
    return Pose2{hold * moved.x, moved.y, hold * moved.angle};
  };
  CHECK(structure_of(slip, 5).p_value < 0.005);
}

}  // namespace
}  // namespace surefoot::diagnosis
