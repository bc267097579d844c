// Linear correction with the command of the cycle before whose gains differ by the side: forward and backward, left and
// right steps, left and right turns. displacement = A (1, dx, dy, dt)^T + B (dx', dy', dt')^T + g (|dx|, |dy|, |dt|)^T
// with a diagonal g: the gain of a forward command is A + g, that of a backward one A - g.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "surefoot/core/pose2.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/motion_model.hpp"
#include "surefoot/motion/previous_command_correction.hpp"

namespace surefoot {

/// The parameter vector lists the 21 of the linear correction, then the three of the sides.
class OneSidedCorrection {
 public:
  static constexpr int parameter_count = 24;
  static constexpr std::string_view name = "linear with previous command and sides";
  using Parameters = Vec<24>;

  /// The walk does what it is told, at once.
  OneSidedCorrection() = default;

  static OneSidedCorrection from_parameters(const Parameters& parameters) {
    OneSidedCorrection result;
    PreviousCommandCorrection::Parameters linear;
    for (int i = 0; i < 21; ++i) linear[i] = parameters[i];
    result.linear_ = PreviousCommandCorrection::from_parameters(linear);
    for (int i = 0; i < 3; ++i) result.sides_[i] = parameters[21 + i];
    return result;
  }

  Parameters parameters() const {
    Parameters result;
    const PreviousCommandCorrection::Parameters linear = linear_.parameters();
    for (int i = 0; i < 21; ++i) result[i] = linear[i];
    for (int i = 0; i < 3; ++i) result[21 + i] = sides_[i];
    return result;
  }

  const PreviousCommandCorrection& linear() const { return linear_; }
  const Vec<3>& sides() const { return sides_; }

  /// Displacement of a cycle with these commands after one with the commands `before`, both (x, y, turn) [m, m, rad].
  Pose2 displacement(const Vec<3>& commands, const Vec<3>& before) const {
    return Pose2::from_vec(linear_.displacement(commands, before).vec() + sides_.cwiseProduct(commands.cwiseAbs()));
  }

  static std::array<ModelParameter, 24> parameter_info() {
    constexpr std::array<ModelParameter, 3> sides{
        {{"dx per |dx|", "1", -1.5, 1.5}, {"dy per |dy|", "1", -1.5, 1.5}, {"dt per |dt|", "1", -1.5, 1.5}}};
    std::array<ModelParameter, 24> info{};
    const auto linear = PreviousCommandCorrection::parameter_info();
    for (std::size_t i = 0; i < 21; ++i) info[i] = linear[i];
    for (std::size_t i = 0; i < 3; ++i) info[21 + i] = sides[i];
    return info;
  }

 private:
  PreviousCommandCorrection linear_;
  Vec<3> sides_ = Vec<3>::Zero();
};

static_assert(MotionModel<OneSidedCorrection>);

}  // namespace surefoot
