// Machines that only a controller outside the model keeps up: growth of differences, and predictions that follow.
#include "surefoot/diagnose/estimation/instability.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

/// A rod that falls over, and the torque at its foot: differences grow with sqrt(tilt), or swing if it hangs.
struct Rod {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;

  SimulatorInfo info() const {
    return {.name = "rod",
            .states = {{"angle", "rad"}, {"speed", "rad/s"}},
            .inputs = {{"torque", "1/s^2"}},
            .outputs = {{"angle_rad", "rad"}},
            .parameters = {{"tilt", "1/s^2", 25, -100, 100}, {"gain", "1", 1, 0.2, 5}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {x[1], p[0] * std::sin(x[0]) + p[1] * u[0]};
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
};

/// Ten seconds of a rod that is balanced by a controller of which only the torques are known; noise 2 mrad.
Recording balanced(int number, double tilt, double gain, double friction) {
  constexpr double row = 0.01, finer = 20;
  Rng rng(static_cast<std::uint64_t>(number) + 1);
  Recording recording = toys::blank_recording(Rod{}.info(), 1000, row);
  recording.name = "balanced_" + std::to_string(number);
  double angle = 0, speed = 0;
  for (Eigen::Index i = 0; i < recording.rows(); ++i) {
    const double aim = 0.1 * std::sin((0.6 + 0.2 * number) * recording.time[i]);
    const double torque = -60 * (angle - aim) - 10 * speed + 2 * rng.normal();
    recording.inputs(0, i) = torque;
    recording.outputs(0, i) = angle + 0.002 * rng.normal();
    for (int k = 0; k < finer; ++k) {
      speed += row / finer * (tilt * std::sin(angle) + gain * torque - friction * std::tanh(speed / 0.01));
      angle += row / finer * speed;
    }
  }
  return recording;
}

std::vector<Recording> log_of(double tilt, double gain, double friction) {
  std::vector<Recording> log;
  for (int number = 0; number < 4; ++number) log.push_back(balanced(number, tilt, gain, friction));
  return log;
}

TEST_CASE("differences grow as fast as an upright rod falls, and not at all where it hangs") {
  for (const double tilt : {9.0, 25.0}) {
    const BoundSimulator bound = bind_simulator(Rod{}, log_of(tilt, 1, 0));
    Hypothesis rod = nominal_hypothesis(bound);
    rod.parameters[0] = tilt;
    CHECK(growth_rate(bound, rod, serially()) == doctest::Approx(std::sqrt(tilt)).epsilon(0.1));
  }
  const BoundSimulator bound = bind_simulator(Rod{}, log_of(25, 1, 0));
  Hypothesis hanging = nominal_hypothesis(bound);
  hanging.parameters[0] = -25;
  CHECK(std::abs(growth_rate(bound, hanging, serially())) < 0.3);
}

TEST_CASE("only what forgets its beginning must be followed, and where a state is measured") {
  BoundSimulator bound = bind_simulator(Rod{}, log_of(25, 1, 0));
  Hypothesis rod = nominal_hypothesis(bound);
  CHECK(needed_follow(bound, rod, serially()) / (3 * 5 * 0.01) == doctest::Approx(1).epsilon(0.1));
  rod.parameters[0] = -25;
  CHECK(needed_follow(bound, rod, serially()) == 0);
  rod.parameters[0] = 25;
  bound.structure.output_of = {-1, -1};
  CHECK(needed_follow(bound, rod, serially()) == 0);
}

TEST_CASE(
    "a simulation that follows nothing falls over where a rod is balanced, and swings as measured where it hangs") {
  BoundSimulator bound = bind_simulator(Rod{}, log_of(25, 1, 0));
  const Hypothesis upright = nominal_hypothesis(bound);
  CHECK_FALSE(moves_as_measured(bound, upright));
  Hypothesis hanging = upright;
  hanging.parameters[0] = -25;
  std::vector<Recording> swinging;
  for (const Recording& one : bound.recordings) {
    Recording other = one;
    for (Eigen::Index i = 0; i < other.rows(); ++i) other.inputs(0, i) = 15 * std::sin(3 * other.time[i]);
    other.outputs = simulate_augmented(Rod{}, toys::machine({-25, 1}), other).outputs;
    swinging.push_back(std::move(other));
  }
  hanging.parameters[1] = 1.1;
  bound = bind_simulator(Rod{}, swinging);
  CHECK(moves_as_measured(bound, hanging));
}

TEST_CASE("a rod that is balanced by a controller of its own is calibrated, and its friction is named") {
  DiagnoseOptions options;
  const auto log = log_of(36, 1.2, 0);
  const Diagnosis plain = diagnose(Rod{}, log, options, Serial{}, 1);
  INFO(plain.sentence);
  CHECK(plain.verdict == Verdict::parameters_only);
  CHECK(plain.parameters[0].fit.value == doctest::Approx(36).epsilon(0.05));
  CHECK(plain.parameters[1].fit.value == doctest::Approx(1.2).epsilon(0.05));
  REQUIRE_FALSE(plain.remarks.empty());
  CHECK(plain.remarks[0].text.find("unstable") != std::string::npos);

  const auto sticky = log_of(25, 1, 1.5);
  const Diagnosis found = diagnose(Rod{}, sticky, options, Serial{}, 1);
  INFO(found.sentence);
  REQUIRE(found.effects.size() == 1);
  CHECK(found.effects[0].name == "coulomb_friction");
  CHECK(found.effects[0].parameters[0].value == doctest::Approx(1.5).epsilon(0.1));
  CHECK(found.noise_ratio < 1.5);
}

}  // namespace
}  // namespace surefoot::diagnosis
