// Starts of the search that no derivative leads to: effects that show only from some size on, as backlash, or a torque
// limit that is never reached by half.
#pragma once

#include "search_point.hpp"

namespace diagnose_robot {

struct StartCriteria {
  double beyond_noise = 1.5;  // times the noise: joints with larger errors are tried, as for the verdict, unless they
                              // are by less than a term must take away
  int most_tries = 2;         // the worst joint first
  int joints = 2;             // of one tree that are tried together, the worst: joints that move each other share
                              // errors, and the cause may be at either
  int finalists = 3;          // of the starts of a joint, that are fitted, beside a size that the motion shows
  int fits = 5;               // moves of each of these
};

class OtherStarts {
 public:
  /// At the worst joints of a tree that were not tried yet: each property alone, at several sizes, in the place of what
  /// the joint has beyond its group. True if the best is more probable than the point, which it replaces. Position
  /// drives only, since torques are as good as linear in everything. Cost: some 120 simulations, and some 30
  /// linearizations by the few terms that are there.
  bool try_next(const Evidence& evidence, const LinearModel& model, Point& point);

 private:
  StartCriteria criteria_;
  std::vector<int> tried_;
  int tries_ = 0;

  std::vector<int> worst_joints(const Evidence& evidence, const Point& point) const;
};

}  // namespace diagnose_robot
