// Ball approaches on the twin as on a robot: the policy knows what a camera and the filter of its sightings tell, the
// robot stops where it believes that it may kick, and time runs until it stands still where it truly may.
#pragma once

#include "../robot/walk/approach_pilot.hpp"
#include "simulated_camera.hpp"
#include "surefoot/core/policy.hpp"
#include "surefoot/core/pose2.hpp"
#include "surefoot/core/rng.hpp"
#include "walking_twin.hpp"

namespace sigmaban {

struct KickApproach {
  double seconds = 0;  // from the first command until it stood still in the kick area, or gave up [s]
  bool reached = false;
  bool fell = false;
  bool lost = false;  // the ball
};

/// From where the robot stands now, with the ball there, for at most `longest` [s]. It stands still when it was not to
/// move for a whole walk cycle. The ball is not touched.
template <class Problem, surefoot::Policy<Problem> Policy>
KickApproach walk_to_kick(const Problem& problem, const Policy& policy, WalkingTwin& robot, const BallView& start,
                          const SimulatedCamera& camera, double longest, const surefoot::Rng& rng) {
  KickApproach result;
  const double begun = robot.twin().time();
  const surefoot::Pose2 ball = robot.twin().pose() * start;
  surefoot::Rng eyes = rng.stream(0);
  auto&& acting = surefoot::start_of_run<Problem>(policy, rng.stream(1));
  ApproachPilot pilot(problem, acting);
  surefoot::Vec<3> speed = surefoot::Vec<3>::Zero();
  while (!result.reached && !result.fell && !result.lost && result.seconds < longest) {
    if (const auto seen = camera.look(robot.twin().pose().inverse() * ball, eyes)) pilot.sighted(*seen);
    const PilotDecision decision = pilot.decide(speed);
    robot.cycle(decision.speed);
    pilot.walked(decision.speed, speed);
    speed = decision.speed;
    const surefoot::Pose2 now = robot.twin().pose().inverse() * ball;
    result.seconds = robot.twin().time() - begun;
    result.fell = robot.fallen();
    result.lost = decision.lost;
    result.reached = !result.fell && decision.may_kick && speed.isZero() && problem.can_kick(now.x, now.y, now.angle);
  }
  return result;
}

}  // namespace sigmaban
