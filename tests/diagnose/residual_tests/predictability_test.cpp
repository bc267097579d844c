// Residuals without memory that still depend on what the machine did.
#include "surefoot/diagnose/residual_tests/predictability.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "surefoot/core/executor.hpp"
#include "tests/support/fitted_walk.hpp"

namespace surefoot::diagnosis {
namespace {

template <class Change>
Comparison predicted(Change&& change, std::uint64_t seed) {
  const toys::FittedWalk walk = toys::fitted_walk(change, seed);
  return residual_predictability(walk.bound, walk.hypothesis, walk.problem, walk.split.folds, serially(), seed);
}

TEST_CASE("steps that are as ordered but for noise cannot be predicted better") {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Comparison found = predicted([](Pose2 moved, Pose2) { return moved; }, seed);
    alarms += found.gain > 0.03 && found.p_value < 0.005 ? 1 : 0;
  }
  CHECK(alarms == 0);
}

TEST_CASE("a twist that depends on the heading is predicted") {
  const auto twist = [](Pose2 moved, Pose2 at) {
    return Pose2{moved.x, moved.y, moved.angle + 0.05 * std::cos(at.angle)};
  };
  const Comparison found = predicted(twist, 3);
  CHECK(found.gain > 0.1);
  CHECK(found.p_value < 0.005);
}

TEST_CASE("the same seed gives the same bits on any number of threads") {
  BoundSimulator bound = bind_simulator(toys::WalkingRobot{},
                                        toys::walk_recordings([](Pose2 moved, Pose2) { return moved; }, false, 12, 1));
  bound.integration.restart = 1;
  FitProblem problem;
  problem.integration = bound.integration;
  problem.weighting.sigma = Eigen::Vector3d(0.003, 0.003, 0.01);
  const std::vector<std::vector<std::size_t>> folds{{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}};
  const Threads two(2);
  const Parallel shared = [&](std::size_t count, const std::function<void(std::size_t)>& job) { two.run(count, job); };
  const Hypothesis nominal = nominal_hypothesis(bound);
  CHECK(residual_predictability(bound, nominal, problem, folds, serially(), 5).gain ==
        residual_predictability(bound, nominal, problem, folds, shared, 5).gain);
}

}  // namespace
}  // namespace surefoot::diagnosis
