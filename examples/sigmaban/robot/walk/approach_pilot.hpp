// From sightings of the ball to the speed of the next walk cycle: filter, edge of the policy's area, policy.
#pragma once

#include <optional>

#include "ball_filter.hpp"
#include "far_ball.hpp"
#include "surefoot/core/vec.hpp"

namespace sigmaban {

/// What the robot does next.
struct PilotDecision {
  surefoot::Vec<3> speed = surefoot::Vec<3>::Zero();  // commanded, within the bounds of the problem
  bool may_kick = false;                              // it believes that it may: the speed is then towards a halt
  bool lost = false;                                  // the ball goes on being far
};

/// `Acting` is what start_of_run() gives for a policy of the problem. Both must outlive the pilot.
template <class Problem, class Acting>
class ApproachPilot {
 public:
  ApproachPilot(const Problem& problem, Acting& acting, const BallFilterCriteria& filter = {},
                const FarBallCriteria& far_ball = {})
      : problem_(&problem), acting_(&acting), filter_(filter), far_(far_ball) {}

  /// A walk cycle with that commanded speed, after one with the speed `before`, is over.
  void walked(const surefoot::Vec<3>& speed, const surefoot::Vec<3>& before) {
    filter_.walked(problem_->expected_walk_cycle(speed, before), problem_->walk_deviation(speed, before));
  }

  void sighted(const BallView& seen) { filter_.sighted(seen); }

  /// Where the robot believes the ball to be.
  std::optional<BallView> ball() const { return filter_.ball(); }

  /// For the cycle that begins, after one with this commanded speed. Towards a halt where nothing is known.
  PilotDecision decide(const surefoot::Vec<3>& speed) {
    PilotDecision decision{.speed = problem_->speed_after(speed, -speed)};
    const std::optional<BallView> known = ball();
    if (!known) return decision;
    const BallView near = far_.within(*known, problem_->constants.max_distance);
    decision.lost = far_.lost();
    decision.may_kick = problem_->can_kick(near.x, near.y, near.angle);
    const auto action = (*acting_)(problem_->arrive(near.x, near.y, near.angle, speed).next);
    if (!decision.may_kick) decision.speed = problem_->speed_after(speed, action);
    return decision;
  }

 private:
  const Problem* problem_;
  Acting* acting_;
  BallFilter filter_;
  FarBall far_;
};

}  // namespace sigmaban
