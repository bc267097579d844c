// A user's own motion model: the proportional correction with a quadratic term in each direction, as of a walk that
// slips more the faster it is.
#pragma once

#include <array>

#include "surefoot/core/vec.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/core/pose2.hpp"

namespace toys {

struct QuadraticCorrection {
  static constexpr int parameter_count = 6;
  static constexpr std::string_view name = "quadratic";

  static std::array<surefoot::ModelParameter, 6> parameter_info() {
    return {{{"dx per dx", "1", 0, 3},
             {"dy per dy", "1", 0, 3},
             {"dt per dt", "1", 0, 3},
             {"dx per dx |dx|", "1/m", -10, 10},
             {"dy per dy |dy|", "1/m", -10, 10},
             {"dt per dt |dt|", "1/rad", -2, 2}}};
  }
  static QuadraticCorrection from_parameters(const surefoot::Vec<6>& p) { return {p.head<3>(), p.tail<3>()}; }
  surefoot::Vec<6> parameters() const { return (surefoot::Vec<6>() << linear, quadratic).finished(); }
  surefoot::Pose2 displacement(const surefoot::Vec<3>& commands) const {
    return surefoot::Pose2::from_vec((linear + quadratic.cwiseProduct(commands.cwiseAbs())).cwiseProduct(commands));
  }

  surefoot::Vec<3> linear = surefoot::Vec<3>::Ones(), quadratic = surefoot::Vec<3>::Zero();
};
static_assert(surefoot::MotionModel<QuadraticCorrection>);

}  // namespace toys
