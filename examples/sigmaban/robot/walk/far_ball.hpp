// A ball beyond the area that a policy was trained for: brought to its edge for the policy, lost only after a while.
#pragma once

#include <cmath>

#include "ball.hpp"

namespace sigmaban {

struct FarBallCriteria {
  int most_sightings = 12;  // in a row without coming closer; to turn round takes eight walk cycles
};

class FarBall {
 public:
  explicit FarBall(const FarBallCriteria& criteria = {}) : criteria_(criteria) {}

  /// The ball in its direction, at most `distance` [m] away.
  BallView within(const BallView& seen, double distance) {
    const double far = std::hypot(seen.x, seen.y);
    if (!(far > distance)) {
      sightings_ = 0;
      return seen;
    }
    if (sightings_ == 0 || far < closest_) sightings_ = 0, closest_ = far;
    ++sightings_;
    const double scale = 0.999 * distance / far;  // inside, however it is rounded
    return {scale * seen.x, scale * seen.y, seen.angle};
  }

  bool lost() const { return sightings_ > criteria_.most_sightings; }

 private:
  FarBallCriteria criteria_;
  int sightings_ = 0;   // beyond the distance, since the closest of them
  double closest_ = 0;  // [m]
};

}  // namespace sigmaban
