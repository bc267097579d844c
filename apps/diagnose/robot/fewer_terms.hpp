// Whether fewer terms do as well: a delay is a lag and some damping where motions are slow, and no linear model sees as
// far as one has to go to do without the others.
#pragma once

#include "search_point.hpp"

namespace diagnose_robot {

struct FewerCriteria {
  int fits = 10;  // moves of what stays
};

/// Leaves each term that shares a joint with another one out in turn, and fits what stays. True if the best such set is
/// as probable as the point, which it replaces. Cost: a few linearizations by the terms of the set for each of them.
bool do_with_fewer(const Evidence& evidence, const LinearModel& model, Point& point,
                   const FewerCriteria& criteria = {});

}  // namespace diagnose_robot
