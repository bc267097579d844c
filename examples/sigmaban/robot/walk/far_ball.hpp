// A ball beyond the area that a policy was trained for: brought to its edge for the policy, lost only after a while.
#pragma once

#include <cmath>

#include "ball.hpp"

namespace sigmaban {

struct FarBallCriteria {
  int most_cycles = 12;  // in a row without coming closer; to turn round takes eight
};

class FarBall {
 public:
  explicit FarBall(const FarBallCriteria& criteria = {}) : criteria_(criteria) {}

  /// Once a walk cycle: the ball in its direction, at most `distance` [m] away.
  BallView within(const BallView& seen, double distance) {
    const double far = std::hypot(seen.x, seen.y);
    if (!(far > distance)) {
      cycles_ = 0;
      return seen;
    }
    if (cycles_ == 0 || far < closest_) cycles_ = 0, closest_ = far;
    ++cycles_;
    const double scale = 0.999 * distance / far;  // inside, however it is rounded
    return {scale * seen.x, scale * seen.y, seen.angle};
  }

  bool lost() const { return cycles_ > criteria_.most_cycles; }

 private:
  FarBallCriteria criteria_;
  int cycles_ = 0;      // beyond the distance, since the closest of them
  double closest_ = 0;  // [m]
};

}  // namespace sigmaban
