// Linear correction that also depends on the command of the cycle before: displacement = A (1, dx, dy, dt)^T + B (dx',
// dy', dt')^T. A walk whose cycles are measured between two phases still carries out part of the last command there; B
// tells how much of it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string_view>

#include "surefoot/core/pose2.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/motion_model.hpp"

namespace surefoot {

/// The full linear correction with the nine coefficients of the previous command. The parameter vector lists the twelve
/// of A row by row, then the nine of B row by row.
class PreviousCommandCorrection {
 public:
  static constexpr int parameter_count = 21;
  static constexpr std::string_view name = "full linear with previous command";
  using Parameters = Vec<21>;
  using Previous = Eigen::Matrix3d;  // rows: dx, dy, dt; columns: dx, dy, dt commanded in the cycle before

  /// The walk does what it is told, at once.
  PreviousCommandCorrection() = default;

  static PreviousCommandCorrection from_parameters(const Parameters& parameters) {
    PreviousCommandCorrection result;
    FullLinearCorrection::Parameters present;
    for (int i = 0; i < 12; ++i) present[i] = parameters[i];
    result.present_ = FullLinearCorrection::from_parameters(present);
    for (int i = 0; i < 9; ++i) result.previous_(i / 3, i % 3) = parameters[12 + i];
    return result;
  }

  Parameters parameters() const {
    Parameters result;
    const FullLinearCorrection::Parameters present = present_.parameters();
    for (int i = 0; i < 12; ++i) result[i] = present[i];
    for (int i = 0; i < 9; ++i) result[12 + i] = previous_(i / 3, i % 3);
    return result;
  }

  const FullLinearCorrection& present() const { return present_; }
  const Previous& previous() const { return previous_; }

  /// Displacement of a cycle with these commands after one with the commands `before`, both (x, y, turn) [m, m, rad].
  Pose2 displacement(const Vec<3>& commands, const Vec<3>& before) const {
    return Pose2::from_vec(present_.displacement(commands).vec() + previous_ * before);
  }

  static std::array<ModelParameter, 21> parameter_info() {
    constexpr std::array<ModelParameter, 9> block{{{"dx per last dx", "1", -1, 1},
                                                   {"dx per last dy", "1", -1, 1},
                                                   {"dx per last dt", "m/rad", -0.5, 0.5},
                                                   {"dy per last dx", "1", -1, 1},
                                                   {"dy per last dy", "1", -1, 1},
                                                   {"dy per last dt", "m/rad", -0.5, 0.5},
                                                   {"dt per last dx", "rad/m", -5, 5},
                                                   {"dt per last dy", "rad/m", -5, 5},
                                                   {"dt per last dt", "1", -1, 1}}};
    std::array<ModelParameter, 21> info{};
    const auto present = FullLinearCorrection::parameter_info();
    for (std::size_t i = 0; i < 12; ++i) info[i] = present[i];
    for (std::size_t i = 0; i < 9; ++i) info[12 + i] = block[i];
    return info;
  }

 private:
  FullLinearCorrection present_;
  Previous previous_ = Previous::Zero();
};

static_assert(MotionModel<PreviousCommandCorrection>);

}  // namespace surefoot
