// Ball approaches played by the twin: the policy sees what it sees in its problem, but the displacements are those of
// the physics engine. The ball lies still and is not touched.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "../approach/approach.hpp"
#include "surefoot/core/policy.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/rng.hpp"
#include "walking_twin.hpp"

namespace sigmaban {

struct PlayedApproach {
  double cost = 0;                     // -(sum of rewards), over the horizon of the problem
  std::optional<int> kick;             // the first cycle after which the robot may kick, from 1
  bool lost = false;                   // the ball
  bool fell = false;                   // costs what losing the ball costs, and ends the run
  surefoot::Pose2 ball;                // position, and the direction of the kick
  std::vector<surefoot::Pose2> cycle;  // poses of the trunk: at the start, and after every cycle
  std::vector<surefoot::Pose2> tick;   // after every command period
};

/// From where the robot stands now. Poses are in the frame of the ground.
template <class Problem, surefoot::Policy<Problem> Policy>
PlayedApproach play_approach(const Problem& problem, const Policy& policy, WalkingTwin& robot,
                             const typename Problem::State& start, const surefoot::Rng& rng) {
  PlayedApproach result;
  const surefoot::Pose2 from = robot.twin().pose();
  result.ball = from * surefoot::Pose2{start[0] * std::cos(start[1]), start[0] * std::sin(start[1]), start[2]};
  result.cycle.push_back(from);
  auto&& acting = surefoot::start_of_run<Problem>(policy, rng);
  typename Problem::State state = start;
  for (int i = 1; i <= Problem::horizon && !result.lost && !result.fell; ++i) {
    const surefoot::Vec<3> speed = problem.speed_after(state.template tail<3>(), acting(state));
    robot.cycle(speed, [&](const Twin& twin) { result.tick.push_back(twin.pose()); });
    const surefoot::Pose2 pose = robot.twin().pose(), seen = pose.inverse() * result.ball;
    result.cycle.push_back(pose);
    result.fell = robot.fallen();
    if (result.fell) {
      result.cost -= problem.constants.lost_reward;
      break;
    }
    const auto step = problem.arrive(seen.x, seen.y, seen.angle, speed);
    result.cost -= step.reward;
    result.lost = step.terminal;
    if (step.reward == 0 && !result.kick) result.kick = i;
    state = step.next;
  }
  return result;
}

}  // namespace sigmaban
