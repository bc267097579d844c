// Linear correction of a walk: displacement = A (1, dx, dy, dt)^T with A of 3 x 4.
// Hofer and Rouxel, "An Operational Method Toward Efficient Walk Control Policies for Humanoid Robots", ICAPS 2017,
// equation 1, in its three sizes: proportional (3 coefficients: the diagonal), simple linear (6: diagonal and offsets),
// full linear (12: all of A).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "surefoot/core/pose2.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/motion/motion_model.hpp"

namespace surefoot {

/// The correction with 3, 6 or 12 free coefficients. The parameter vector lists the free entries of A row by row.
template <int Count>
requires(Count == 3 || Count == 6 || Count == 12) class LinearCorrection {
 public:
  static constexpr int parameter_count = Count;
  static constexpr std::string_view name = Count == 3 ? "proportional" : Count == 6 ? "simple linear" : "full linear";
  using Parameters = Vec<Count>;
  using Matrix = Eigen::Matrix<double, 3, 4>;  // rows: dx, dy, dt; columns: offset, commanded dx, dy, dt

  /// The walk does what it is told.
  LinearCorrection() : LinearCorrection(identity()) {}

  static LinearCorrection from_parameters(const Parameters& parameters) {
    LinearCorrection correction{Matrix::Zero()};
    for (int i = 0; i < Count; ++i) correction.matrix_(row(i), column(i)) = parameters[i];
    return correction;
  }

  Parameters parameters() const {
    Parameters result;
    for (int i = 0; i < Count; ++i) result[i] = matrix_(row(i), column(i));
    return result;
  }

  const Matrix& matrix() const { return matrix_; }

  /// Displacement of a cycle with these commands (x, y, turn) [m, m, rad].
  Pose2 displacement(const Vec<3>& commands) const {
    const auto along = [&](int row, int column) { return matrix_(row, column) * commands[column - 1]; };
    return {.x = matrix_(0, 0) + (along(0, 1) + along(0, 2) + along(0, 3)),
            .y = matrix_(1, 0) + (along(1, 1) + along(1, 2) + along(1, 3)),
            .angle = matrix_(2, 0) + (along(2, 1) + (along(2, 2) + along(2, 3)))};
  }

  static std::array<ModelParameter, std::size_t{Count}> parameter_info() {
    std::array<ModelParameter, std::size_t{Count}> info;
    for (int i = 0; i < Count; ++i) info[static_cast<std::size_t>(i)] = entry(row(i), column(i));
    return info;
  }

 private:
  explicit LinearCorrection(Matrix matrix) : matrix_(std::move(matrix)) {}

  static Matrix identity() {
    Matrix matrix = Matrix::Zero();
    for (int i = 0; i < 3; ++i) matrix(i, i + 1) = 1;
    return matrix;
  }

  // Where in A parameter i stands.
  static constexpr int row(int i) { return i / (Count / 3); }
  static constexpr int column(int i) {
    if constexpr (Count == 3) return i + 1;
    if constexpr (Count == 6) return i % 2 == 0 ? 0 : i / 2 + 1;
    return i % 4;
  }

  // Ranges wide enough for every walk that still deserves the name.
  static constexpr ModelParameter entry(int row, int column) {
    constexpr std::array<std::array<ModelParameter, 4>, 3> entries{{
        {{{"dx offset", "m", -0.05, 0.05},
          {"dx per dx", "1", 0, 3},
          {"dx per dy", "1", -1, 1},
          {"dx per dt", "m/rad", -0.5, 0.5}}},
        {{{"dy offset", "m", -0.05, 0.05},
          {"dy per dx", "1", -1, 1},
          {"dy per dy", "1", 0, 3},
          {"dy per dt", "m/rad", -0.5, 0.5}}},
        {{{"dt offset", "rad", -0.3, 0.3},
          {"dt per dx", "rad/m", -5, 5},
          {"dt per dy", "rad/m", -5, 5},
          {"dt per dt", "1", 0, 3}}},
    }};
    return entries[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
  }

  Matrix matrix_;
};

using ProportionalCorrection = LinearCorrection<3>;
using SimpleLinearCorrection = LinearCorrection<6>;
using FullLinearCorrection = LinearCorrection<12>;

static_assert(MotionModel<ProportionalCorrection> && MotionModel<SimpleLinearCorrection> &&
              MotionModel<FullLinearCorrection>);

}  // namespace surefoot
