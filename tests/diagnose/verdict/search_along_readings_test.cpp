// What predictions along the readings show where simulations of whole recordings are lost.
#include "surefoot/diagnose/verdict/search_along_readings.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/verdict/recording_stage.hpp"

namespace surefoot::diagnosis {
namespace {

/// A motor that turns freely, in newton metres.
struct Gimbal {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;

  SimulatorInfo info() const {
    return {.name = "gimbal",
            .states = {{"angle", "rad"}, {"rate", "rad/s"}},
            .inputs = {{"torque", "N m"}},
            .outputs = {{"angle_rad", "rad"}},
            .parameters = {{"inertia", "kg m^2", 2e-4, 3e-5, 2e-3}, {"damping", "N m s/rad", 2e-3, 1e-4, 0.02}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {x[1], (u[0] - p[1] * x[1]) / p[0]};
  }
  State effort(const State& /*x*/, const Input& /*u*/, const Eigen::VectorXd& p) const { return {1, p[0]}; }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
};
static_assert(Simulator<Gimbal>);

/// Torques of a controller that moves it over detents, as recorded, and the angle that it came to.
Recording held_over_detents(int r, double detents) {
  constexpr int rows = 600, parts = 100;
  constexpr double step = 0.005, inertia = 1.8e-4, damping = 1.6e-3, noise = 2e-4;
  constexpr double stiffness = 0.05, braking = 0.004, torque_resolution = 1e-4;
  Recording recording;
  recording.name = "gimbal " + std::to_string(r);
  recording.time.setLinSpaced(rows, 0, (rows - 1) * step);
  recording.inputs.setZero(1, rows);
  recording.outputs.setZero(1, rows);
  Rng rng(5, static_cast<std::uint64_t>(r));
  double angle = 0.3 * r, rate = 0, goal = angle;
  recording.initial = Eigen::Vector2d(angle, 0);
  recording.initial_scale = Eigen::Vector2d::Zero();
  for (int row = 0; row < rows; ++row) {
    recording.outputs(0, row) = angle + noise * rng.normal();
    if (row % 80 == 0) goal += 2 * rng.uniform() - 1;
    const double asked = stiffness * (goal - recording.outputs(0, row)) - braking * rate;
    const double torque = torque_resolution * std::round(asked / torque_resolution);
    recording.inputs(0, row) = torque;
    for (int i = 0; i < parts; ++i) {  // semi-implicit Euler
      rate += step / parts * (torque - damping * rate - detents * std::sin(14 * angle)) / inertia;
      angle += step / parts * rate;
    }
  }
  return recording;
}

std::vector<Recording> gimbal_recordings(double detents) {
  std::vector<Recording> recordings;
  for (int r = 0; r < 4; ++r) recordings.push_back(held_over_detents(r, detents));
  return recordings;
}

DiagnoseOptions few_effects() {
  DiagnoseOptions options;
  options.effects = {"cogging", "coulomb_friction", "viscous_friction"};
  options.starts = 2;
  return options;
}

bool along(double detents, const RunContext& run, FoundModel& found) {
  const auto bind = [](std::vector<Recording> some) { return bind_simulator(Gimbal{}, std::move(some)); };
  EstimationSetup setup = hold_out_recordings(bind, gimbal_recordings(detents), run);
  return search_along_readings(setup, run, found);
}

TEST_CASE("detents under recorded torques show along the readings") {
  const DiagnoseOptions options = few_effects();
  const Parallel parallel = serially();
  RunContext run{options, parallel};
  run.began -= std::chrono::hours(1);  // so that there is time
  FoundModel found;
  REQUIRE(along(0.01, run, found));
  REQUIRE(found.hypothesis.effects.size() == 1);
  CHECK(found.hypothesis.effects[0].effect->name == "cogging");
  CHECK(found.follow == 0);           // most of these recordings stay between two detents
  CHECK_FALSE(along(0, run, found));  // nothing is missing
  run.began = std::chrono::steady_clock::now();
  CHECK_FALSE(along(0.01, run, found));  // no time
}

TEST_CASE("a diagnosis whose simulations are lost tries what shows along the readings") {
  const Diagnosis diagnosis = diagnose(Gimbal{}, gimbal_recordings(0.01), few_effects(), Threads{2}, 1);
  REQUIRE(diagnosis.effects.size() == 1);
  CHECK(diagnosis.effects[0].name == "cogging");
}

}  // namespace
}  // namespace surefoot::diagnosis
