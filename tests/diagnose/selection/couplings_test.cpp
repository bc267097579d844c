// What holds two bodies together: a signal that no input drives, and what may be wrong with it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

/// Two wheels on an elastic shaft, the first one driven. Signal 1 brakes one of them alone.
struct Shaft {
  using State = Vec<4>;
  using Input = Vec<1>;
  using Output = Vec<2>;
  SimulatorInfo info() const {
    return {.name = "shaft",
            .states = {{"motor", "rad"}, {"load", "rad"}, {"wm", "rad/s"}, {"wl", "rad/s"}},
            .inputs = {{"torque", "N m"}},
            .outputs = {{"motor_rad", "rad"}, {"load_rad", "rad"}},
            .parameters = {{"stiffness", "N m/rad", 3, 1, 10}, {"braking", "N m s/rad", 0.02, 0.001, 0.1}},
            .signals = {"twist", "brake", "drive"}};
  }
  template <class Tap>
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p, Tap&& tap) const {
    const double twist = tap(0, p[0] * (x[0] - x[1]) + 0.02 * (x[2] - x[3])), brake = tap(1, p[1] * x[2]);
    return {x[2], x[3], (tap(2, 2 * u[0]) - twist - brake) / 0.02, twist / 0.04};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return derivative(x, u, p, NoTap{});
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return {x[0], x[1]}; }
};

std::vector<Recording> shaft_logs(const std::vector<NamedEffect>& effects) {
  std::vector<Recording> recordings;
  Rng rng(3);
  for (int r = 0; r < 5; ++r) {
    Recording recording = toys::blank_recording(Shaft{}.info(), 300, 0.01);
    recording.name = "shaft " + std::to_string(r);
    for (Eigen::Index i = 0; i < recording.rows(); ++i) {
      recording.inputs(0, i) = 0.15 * std::sin((3 + r) * recording.time[i]) + 0.1 * std::sin(11 * recording.time[i]);
    }
    recording.outputs = simulate_augmented(Shaft{}, toys::machine({4, 0.02}, effects), recording).outputs;
    for (double& angle : recording.outputs.reshaped()) angle += 0.001 * rng.normal();
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

TEST_CASE("a coupling is a signal that no input drives, and that moves several bodies") {
  const BoundSimulator bound = bind_simulator(Shaft{}, shaft_logs({}));
  CHECK(bound.structure.coupling == std::vector<bool>{true, false, false});
  const std::vector<AttachedEffect> all = attachments(bound, all_effects(), {true, true, false, true});
  const auto has = [&](const std::string& label) {
    return std::ranges::any_of(all, [&](const AttachedEffect& one) { return one.label() == label; });
  };
  CHECK(has("backlash at twist"));
  CHECK(has("cubic_stiffness at twist"));
  CHECK_FALSE(has("dead_zone at twist"));  // of what is driven
  CHECK(has("dead_zone at drive"));
  CHECK_FALSE(has("backlash at drive"));
}

TEST_CASE("backlash and hardening of a shaft between two bodies are named there") {
  const auto named = [](const NamedEffect& hidden) {
    DiagnoseOptions options;
    options.effects = {"backlash", "cubic_stiffness", "coulomb_friction", "viscous_friction", "sensor_scale"};
    options.max_effects = 2;
    return diagnose(Shaft{}, shaft_logs({hidden}), options, Threads{}, 1);
  };
  const Diagnosis gap = named({"backlash", "twist", "coupling", {}, {0.06}});
  CHECK(gap.verdict == Verdict::missing_physics);
  REQUIRE(gap.effects.size() == 1);
  CHECK(gap.effects[0].name == "backlash");
  CHECK(gap.effects[0].attached_to == "twist");
  CHECK(gap.effects[0].parameters[0].value == doctest::Approx(0.06).epsilon(0.05));
  const Diagnosis hard = named({"cubic_stiffness", "twist", "coupling", {}, {20}});
  REQUIRE(hard.effects.size() == 1);
  CHECK(hard.effects[0].attached_to == "twist");
  CHECK(hard.effects[0].parameters[0].value == doctest::Approx(20).epsilon(0.1));
}

}  // namespace
}  // namespace surefoot::diagnosis
