// Three simple machines on which the catalogue shows what an effect does: an arm, two tanks, and a robot that walks.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/recording.hpp"
#include "surefoot/diagnose/simulator.hpp"
#include "surefoot/core/pose2.hpp"

namespace catalogue {

using surefoot::Vec;

/// A motor that swings a weight: 0.02 kg m^2, 0.1 N m s/rad, 0.5 N m of weight at the horizontal.
struct Arm {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;

  surefoot::SimulatorInfo info() const {
    return {.name = "arm",
            .states = {{"angle", "rad"}, {"speed", "rad/s", "N m"}},
            .inputs = {{"torque", "N m"}},
            .outputs = {{"angle", "rad"}},
            .parameters = {{"weight", "N m", 0.5, 0.1, 1}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {x[1], (u[0] - 0.1 * x[1] - p[0] * std::sin(x[0])) / 0.02};
  }
  State effort(const State&, const Input&, const Eigen::VectorXd&) const { return {1, 0.02}; }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return Output(x[0]); }

  /// A slow swing, then steps, 200 rows a second.
  static surefoot::Recording commands() {
    surefoot::Recording recording;
    constexpr Eigen::Index rows = 1601;
    recording.time.setLinSpaced(rows, 0, 0.005 * (rows - 1));
    recording.inputs.resize(1, rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double t = recording.time[i];
      const double swing = 0.22 * std::sin(2 * std::numbers::pi * 0.5 * t);
      recording.inputs(0, i) = t < 4 ? swing : std::fmod(t, 2) < 1 ? 0.2 : -0.15;
    }
    recording.outputs.setZero(1, rows);
    recording.initial = recording.initial_scale = Vec<2>::Zero();
    return recording;
  }
};
static_assert(surefoot::Simulator<Arm>);

/// Two tanks, one above the other, that empty by 0.2 of their level per second.
struct Tanks {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;

  surefoot::SimulatorInfo info() const {
    return {.name = "tanks",
            .states = {{"upper", "m"}, {"lower", "m"}},
            .inputs = {{"inflow", "m/s"}},
            .outputs = {{"level", "m"}},
            .parameters = {}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd&) const {
    return {u[0] - 0.2 * x[0], 0.2 * x[0] - 0.2 * x[1]};
  }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return Output(x[0]); }

  /// The pump is on for 15 s of every 30.
  static surefoot::Recording commands() {
    surefoot::Recording recording;
    constexpr Eigen::Index rows = 601;
    recording.time.setLinSpaced(rows, 0, 0.1 * (rows - 1));
    recording.inputs.resize(1, rows);
    for (Eigen::Index i = 0; i < rows; ++i) recording.inputs(0, i) = std::fmod(recording.time[i], 30) < 15 ? 0.1 : 0;
    recording.outputs.setZero(1, rows);
    recording.initial = recording.initial_scale = Vec<2>::Zero();
    return recording;
  }
};
static_assert(surefoot::Simulator<Tanks>);

/// Goes where each command says.
struct Walker {
  using State = Vec<3>;
  using Input = Vec<3>;
  using Output = Vec<3>;

  surefoot::SimulatorInfo info() const {
    return {.name = "walker",
            .kind = surefoot::SimulatorKind::map,
            .states = {{"x", "m"}, {"y", "m"}, {"heading", "rad"}},
            .inputs = {{"forward", "m"}, {"lateral", "m"}, {"turn", "rad"}},
            .outputs = {{"x", "m"}, {"y", "m"}, {"heading", "rad"}},
            .parameters = {},
            .planar = surefoot::PlanarInfo{}};
  }
  State next(const State& x, const Input& u, const Eigen::VectorXd&) const {
    const surefoot::Pose2 after = surefoot::Pose2::from_vec(x) * surefoot::Pose2{u[0], u[1], u[2]};
    return {after.x, after.y, x[2] + u[2]};
  }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return x; }

  /// Straight on, a turn to the left, straight on, sideways.
  static surefoot::Recording commands() {
    surefoot::Recording recording;
    constexpr Eigen::Index rows = 41;
    recording.time.setLinSpaced(rows, 0, rows - 1);
    recording.inputs.setZero(3, rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      if (i < 10) recording.inputs(0, i) = 0.06;
      if (i >= 10 && i < 20) recording.inputs.col(i) << 0.04, 0, 0.2;
      if (i >= 20 && i < 30) recording.inputs(0, i) = 0.03;
      if (i >= 30) recording.inputs.col(i) << 0.01, 0.04, 0;
    }
    recording.outputs.setZero(3, rows);
    recording.initial = recording.initial_scale = Vec<3>::Zero();
    return recording;
  }
};
static_assert(surefoot::Simulator<Walker>);

}  // namespace catalogue
