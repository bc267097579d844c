// A robot that walks as ordered, but for three gains: the map on which diagnoses are tested, and recordings of it.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/pose2.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/effects/effect.hpp"
#include "surefoot/diagnose/recording.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace toys {

/// Orders per step (forward, lateral, turn) in, pose out [m, m, rad].
struct WalkingRobot {
  using State = surefoot::Vec<3>;
  using Input = surefoot::Vec<3>;
  using Output = surefoot::Vec<3>;

  surefoot::SimulatorInfo info() const {
    return {.name = "walk",
            .kind = surefoot::SimulatorKind::map,
            .states = {{"x", "m"}, {"y", "m"}, {"heading", "rad"}},
            .inputs = {{"forward", "m"}, {"lateral", "m"}, {"turn", "rad"}},
            .outputs = {{"x_m", "m"}, {"y_m", "m"}, {"heading_rad", "rad"}},
            .parameters = {{"a", "1", 1, 0.2, 3}, {"b", "1", 1, 0.2, 3}, {"c", "1", 1, 0.2, 3}},
            .planar = surefoot::PlanarInfo{}};
  }
  State next(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    const surefoot::Pose2 after = surefoot::Pose2::from_vec(x) * surefoot::Pose2{p[0] * u[0], p[1] * u[1], p[2] * u[2]};
    return {after.x, after.y, x[2] + p[2] * u[2]};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};
static_assert(surefoot::Simulator<WalkingRobot>);

/// Sequences of 25 steps of random orders. `change` is what really becomes of a displacement, where it begins; each
/// step has noise (3 mm, 10 mrad). Poses are measured after every step, or in the end only, by tape (5 mm, 20 mrad).
template <class Change>
std::vector<surefoot::Recording> walk_recordings(Change&& change, bool final_pose_only, int count, std::uint64_t seed) {
  std::vector<surefoot::Recording> recordings;
  for (int r = 0; r < count; ++r) {
    surefoot::Rng rng(seed, static_cast<std::uint64_t>(r));
    surefoot::Recording recording;
    recording.name = "sequence " + std::to_string(r);
    constexpr Eigen::Index rows = 26;
    recording.time.setLinSpaced(rows, 0, rows - 1);
    recording.inputs.setZero(3, rows);
    recording.outputs.setConstant(3, rows, std::numeric_limits<double>::quiet_NaN());
    recording.outputs.col(0).setZero();
    recording.initial = recording.initial_scale = surefoot::Vec<3>::Zero();
    surefoot::Vec<3> orders = surefoot::Vec<3>::Zero();
    surefoot::Pose2 pose;
    double heading = 0;
    for (Eigen::Index i = 0; i + 1 < rows; ++i) {
      orders += surefoot::Vec<3>(0.04, 0.02, 0.3)
                    .cwiseProduct(surefoot::Vec<3>(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5));
      orders = orders.cwiseMax(surefoot::Vec<3>(-0.02, -0.02, -0.2)).cwiseMin(surefoot::Vec<3>(0.04, 0.02, 0.2));
      recording.inputs.col(i) = orders;
      surefoot::Pose2 moved = change(surefoot::Pose2{1.2 * orders[0], 0.9 * orders[1], 1.1 * orders[2]}, pose);
      moved.x += 0.003 * rng.normal();
      moved.y += 0.003 * rng.normal();
      moved.angle += 0.01 * rng.normal();
      pose = pose * moved;
      heading += moved.angle;
      if (!final_pose_only) recording.outputs.col(i + 1) << pose.x, pose.y, heading;
    }
    if (final_pose_only) {
      recording.outputs.col(rows - 1) << pose.x + 0.005 * rng.normal(), pose.y + 0.005 * rng.normal(),
          heading + 0.02 * rng.normal();
    }
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

}  // namespace toys
