// Definitions of surefoot/motion/changes/possible_changes.hpp.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/changes/possible_changes.hpp"

namespace surefoot::detail {

/// -1 if the model has none of that name.
SUREFOOT_INLINE int coefficient_named(const AnyMotionModel& model, std::string_view name) {
  int i = 0;
  for (const ModelParameter& info : model.parameter_info()) {
    if (info.name == name) return i;
    ++i;
  }
  return -1;
}

SUREFOOT_INLINE void add_sides(const AnyMotionModel& model, double jump, std::vector<WalkChange>& changes) {
  struct Side {
    std::string_view gain, side, above, below;
  };
  constexpr std::array<Side, 3> sides{{{"dx per dx", "dx per |dx|", "forward", "backward"},
                                       {"dy per dy", "dy per |dy|", "to the left", "to the right"},
                                       {"dt per dt", "dt per |dt|", "to the left", "to the right"}}};
  for (const Side& one : sides) {
    const int gain = coefficient_named(model, one.gain), side = coefficient_named(model, one.side);
    if (gain < 0 || side < 0) continue;
    for (const bool above : {true, false}) {  // of the gain of that side alone, by 1
      Eigen::VectorXd direction = Eigen::VectorXd::Zero(model.parameter_count());
      direction[gain] = 0.5;
      direction[side] = above ? 0.5 : -0.5;
      changes.push_back({.name = std::string(one.gain) + " " + std::string(above ? one.above : one.below),
                         .direction = direction,
                         .deviation = jump * model.parameter_box().width()[gain]});
    }
  }
}

/// Of what is done at once and in the next cycle, by the same factor: of a gain where part of it comes later.
SUREFOOT_INLINE void add_whole_gains(const AnyMotionModel& model, double deviation, std::vector<WalkChange>& changes) {
  constexpr double least_share = 0.2;  // of the next cycle; with less it is as if the gain alone changed
  for (const std::string of : {"dx", "dy", "dt"}) {
    const int present = coefficient_named(model, of + " per " + of),
              last = coefficient_named(model, of + " per last " + of);
    if (present < 0 || last < 0) continue;
    if (std::abs(model.parameters()[last]) < least_share * std::abs(model.parameters()[present])) continue;
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(model.parameter_count());
    direction[present] = model.parameters()[present];
    direction[last] = model.parameters()[last];
    changes.push_back({.name = of + " per " + of + " and last " + of, .direction = direction, .deviation = deviation});
  }
}

/// What is done in the next cycle in place of this one, to first order: every coefficient of a command moves on to that
/// of the last command.
SUREFOOT_INLINE void add_part_of_cycle(const AnyMotionModel& model, double deviation, std::vector<WalkChange>& changes) {
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(model.parameter_count());
  for (const std::string of : {"dx", "dy", "dt"}) {
    for (const std::string per : {"dx", "dy", "dt"}) {
      const int present = coefficient_named(model, of + " per " + per),
                last = coefficient_named(model, of + " per last " + per);
      if (present < 0 || last < 0) return;
      direction[present] = -model.parameters()[present];
      direction[last] = model.parameters()[present] - model.parameters()[last];
    }
  }
  changes.push_back({.name = "part of a cycle", .direction = direction, .deviation = deviation});
}

SUREFOOT_INLINE std::vector<WalkChange> possible_changes(const AnyMotionModel& before, double jump, double delay,
                                                         bool sides_calibrated) {
  constexpr double widest_gain = 3;  // width of the range of a gain: a factor, as that of a gain of 1
  std::vector<WalkChange> changes;
  const Eigen::VectorXd width = before.parameter_box().width();
  Eigen::Index i = 0;
  for (const ModelParameter& info : before.parameter_info()) {
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(width.size());
    direction[i] = 1;
    const bool of_sides = info.name.find('|') != std::string_view::npos;
    if (!of_sides) {
      changes.push_back({.name = std::string(info.name), .direction = direction, .deviation = jump * width[i]});
    }
    ++i;
  }
  if (sides_calibrated) add_sides(before, jump, changes);
  add_whole_gains(before, jump * widest_gain, changes);
  add_part_of_cycle(before, delay, changes);
  return changes;
}

}  // namespace surefoot::detail
