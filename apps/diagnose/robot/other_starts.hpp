// Starts of the search that no derivative leads to: effects that show only from some size on, as backlash, or a torque
// limit that is never reached by half.
#pragma once

#include "search_point.hpp"

namespace diagnose_robot {

struct StartCriteria {
  double beyond_noise = 1.5;  // times the noise: joints with larger errors are tried, as for the verdict, unless they
                              // are by less than a term must take away
  int most_joints = 2;        // the worst first
  int finalists = 3;          // of the starts of a joint, that are fitted
  int fits = 5;               // moves of each of these
};

class OtherStarts {
 public:
  /// At the worst joint that was not tried yet: each property alone, at several sizes, in the place of what the joint
  /// has beyond its group. True if one is more probable than the point, which it replaces. Position drives only, since
  /// torques are as good as linear in everything. Cost: some 60 simulations, and some
  /// 15 linearizations by the few terms that are there.
  bool try_next(const Evidence& evidence, const LinearModel& model, Point& point);

 private:
  StartCriteria criteria_;
  std::vector<int> tried_;

  int worst_joint(const Evidence& evidence, const Point& point) const;
};

}  // namespace diagnose_robot
