// A servo that swings a pendulum, and logs of it with physics that the model leaves out.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/log_doctor/examine_log.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"

namespace toys {

/// A position servo: a spring towards the goal, a damper, and gravity.
struct Servo {
  using State = surefoot::Vec<2>;
  using Input = surefoot::Vec<1>;
  using Output = surefoot::Vec<2>;

  surefoot::SimulatorInfo info() const {
    return {.name = "servo",
            .states = {{"theta", "rad"}, {"omega", "rad/s"}},
            .inputs = {{"goal", "rad"}},
            .outputs = {{"theta_rad", "rad"}, {"omega_rad_s", "rad/s"}},
            .parameters = {{"stiffness", "1/s^2", 80, 20, 200}, {"damping", "1/s", 9, 1, 40}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {x[1], p[0] * (u[0] - x[0]) - p[1] * x[1] - 20 * std::sin(x[0])};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};
static_assert(surefoot::Simulator<Servo>);

/// Recordings of 300 rows at 100 Hz of a machine with other parameters than the model's and these effects; goals in
/// steps, other amplitudes in each.
inline std::vector<surefoot::Recording> servo_log(const std::vector<surefoot::NamedEffect>& effects = {},
                                                  int count = 6) {
  std::vector<surefoot::Recording> log;
  surefoot::Rng rng(7);
  for (int r = 0; r < count; ++r) {
    surefoot::Recording recording;
    recording.name = "rec_0" + std::to_string(r + 1) + ".csv";
    recording.time.setLinSpaced(300, 0, 2.99);
    recording.inputs.setZero(1, 300);
    recording.outputs.setZero(2, 300);
    recording.initial = recording.initial_scale = Eigen::Vector2d::Zero();
    double level = 0;
    for (Eigen::Index row = 0; row < 300; ++row) {
      if (row % 50 == 10) level = (0.5 + 0.15 * r) * (2 * rng.uniform() - 1) + (row % 100 == 10 ? 0.5 : -0.4);
      recording.inputs(0, row) = level + 0.1 * std::sin((4 + 0.5 * r) * recording.time[row]);
    }
    surefoot::Augmented machine;
    machine.parameters = {90, 8};
    machine.effects = effects;
    recording.outputs = simulate_augmented(Servo{}, machine, recording).outputs;
    for (Eigen::Index row = 0; row < 300; ++row) {
      recording.outputs(0, row) += 0.002 * rng.normal();
      recording.outputs(1, row) += 0.02 * rng.normal();
    }
    recording.outputs.col(0).setZero();
    log.push_back(std::move(recording));
  }
  return log;
}

inline std::vector<surefoot::NamedEffect> dry_friction() { return {{"coulomb_friction", "omega", {}, {}, {4.0}}}; }

/// Outputs `late` [s] after the inputs, which begin at rest.
inline void delay_outputs(surefoot::Recording& recording, double late) {
  const surefoot::Recording before = recording;
  const auto rows = static_cast<Eigen::Index>(std::lround(late * 100));
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {
    const Eigen::Index from = row < rows ? rows - row : row - rows;
    for (Eigen::Index k = 0; k < 2; ++k) recording.outputs(k, row) = before.outputs(k, from);
  }
}

/// Outputs `early` [s] before the inputs; the last ones are not there.
inline void advance_outputs(surefoot::Recording& recording, double early) {
  const surefoot::Recording before = recording;
  const auto rows = static_cast<Eigen::Index>(std::lround(early * 100));
  for (Eigen::Index row = 0; row < recording.rows(); ++row) {
    for (Eigen::Index k = 0; k < 2; ++k) {
      recording.outputs(k, row) =
          row + rows < recording.rows() ? before.outputs(k, row + rows) : std::numeric_limits<double>::quiet_NaN();
    }
  }
}

inline surefoot::diagnosis::LogDoctorInputs servo_doctor(const surefoot::diagnosis::Parallel& parallel) {
  using namespace surefoot::diagnosis;
  const auto bind = [](std::vector<surefoot::Recording> some) { return bind_simulator(Servo{}, std::move(some)); };
  return {bind, [](const BoundSimulator& bound) { return nominal_hypothesis(bound); }, parallel};
}

inline surefoot::diagnosis::LogExamination examined(const std::vector<surefoot::Recording>& log) {
  const surefoot::diagnosis::Parallel parallel = surefoot::diagnosis::serially();
  return examine_log(servo_doctor(parallel), log);
}

}  // namespace toys
