// The same effect on two inputs at once, where the search began with others that resemble their sum.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

struct Rover {
  using State = Vec<3>;
  using Input = Vec<2>;
  using Output = Vec<3>;
  SimulatorInfo info() const {
    return {.name = "rover",
            .states = {{"x", "m"}, {"y", "m"}, {"yaw", "rad"}},
            .inputs = {{"left", "rad/s"}, {"right", "rad/s"}},
            .outputs = {{"x_m", "m"}, {"y_m", "m"}, {"yaw_rad", "rad"}},
            .parameters = {{"radius", "m", 0.055, 0.03, 0.08}, {"base", "m", 0.24, 0.15, 0.5}},
            .signals = {"speed", "turning"}};
  }
  template <class Tap>
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p, Tap&& tap) const {
    const double speed = tap(0, p[0] * (u[0] + u[1]) / 2), turning = tap(1, p[0] * (u[1] - u[0]) / p[1]);
    return {speed * std::cos(x[2]), speed * std::sin(x[2]), turning};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return derivative(x, u, p, NoTap{});
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};

TEST_CASE("two wheels that are limited are found, and a late sensor beside them") {
  std::vector<Recording> recordings;
  Rng rng(5);
  const std::vector<NamedEffect> hidden{{"saturation", "left", {}, {}, {6}},
                                        {"saturation", "right", {}, {}, {6}},
                                        {"sensor_delay", "yaw_rad", {}, {}, {0.12}}};
  for (int r = 0; r < 6; ++r) {
    Recording recording = toys::blank_recording(Rover{}.info(), 400, 0.02);
    recording.name = "run " + std::to_string(r);
    for (Eigen::Index i = 0; i < recording.rows(); ++i) {
      for (Eigen::Index k = 0; k < 2; ++k) {
        recording.inputs(k, i) = i % 40 == 0 ? 4 + 12 * (rng.uniform() - 0.3) : recording.inputs(k, i - 1);
      }
    }
    recording.outputs = simulate_augmented(Rover{}, toys::machine({0.048, 0.27}, hidden), recording).outputs;
    for (double& reading : recording.outputs.reshaped()) reading += 0.003 * rng.normal();
    recordings.push_back(std::move(recording));
  }
  DiagnoseOptions options;
  options.effects = {"saturation", "supply_sag", "sensor_delay", "dead_zone", "input_gain", "first_order_lag"};
  const Diagnosis found = diagnose(Rover{}, recordings, options, Threads{}, 1);
  CHECK(found.verdict == Verdict::missing_physics);
  std::vector<std::string> names;
  for (const FoundEffect& one : found.effects) names.push_back(one.name + " at " + one.attached_to);
  std::ranges::sort(names);
  CHECK(names == std::vector<std::string>{"saturation at left", "saturation at right", "sensor_delay at yaw_rad"});
}

}  // namespace
}  // namespace surefoot::diagnosis
