// Cogging of machines that turn round.
#include "surefoot/diagnose/effects/cogging.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/diagnose.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot {
namespace {

/// A rotor with a damper, by the torque of its motor.
struct Rotor {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;

  SimulatorInfo info() const {
    return {.name = "rotor",
            .states = {{"angle", "rad"}, {"speed", "rad/s", "N m"}},
            .inputs = {{"torque", "N m"}},
            .outputs = {{"angle_rad", "rad"}},
            .parameters = {{"inertia", "kg m^2", 0.01, 0.002, 0.05}, {"damping", "N m s", 0.02, 0.001, 0.2}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {x[1], (u[0] - p[1] * x[1]) / p[0]};
  }
  State effort(const State& /*x*/, const Input& /*u*/, const Eigen::VectorXd& p) const { return {1, p[0]}; }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return Output(x[0]); }
};

TEST_CASE("cogging of a rotor that turns round is found by its number per turn") {
  for (const double per_turn : {7.0, 18.0}) {
    CAPTURE(per_turn);
    std::vector<Recording> logs;
    Rng rng(5);
    for (int r = 0; r < 5; ++r) {
      Recording log = toys::blank_recording(Rotor{}.info(), 400, 0.01);
      log.name = "turn_" + std::to_string(r);
      for (Eigen::Index i = 0; i < log.rows(); ++i) {
        log.inputs(0, i) = 0.12 + 0.03 * r + 0.1 * std::sin((1 + 0.4 * r) * log.time[i]);
      }
      const NamedEffect hidden{"cogging", "speed", "per turn", {}, {0.05, 0.03, per_turn}};
      log.outputs = simulate_augmented(Rotor{}, toys::machine({0.011, 0.018}, {hidden}, {.step = 0.0005}), log).outputs;
      for (double& angle : log.outputs.reshaped()) angle += 0.001 * rng.normal();
      logs.push_back(std::move(log));
    }
    CHECK(logs[0].outputs.maxCoeff() > 12);  // two turns and more
    const Diagnosis found = diagnose(Rotor{}, logs, {}, Threads{}, 1);
    INFO(found.sentence);
    REQUIRE(found.effects.size() == 1);
    CHECK(found.effects[0].name == "cogging");
    CHECK(found.effects[0].form == "per turn");
    CHECK(found.effects[0].parameters[2].value == doctest::Approx(per_turn).epsilon(0.01));
    CHECK(found.noise_ratio < 1.2);
  }
}

TEST_CASE("what never repeats within the travel is no cogging") {
  const double travel_of_even_motion = std::sqrt(12.0);  // in deviations of the position
  CHECK(effects::cogging().parameters[2].high < 1.2 * travel_of_even_motion);
}

}  // namespace
}  // namespace surefoot
