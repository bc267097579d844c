// Effects on any state, on two tanks, the first of which is filled: leaks, constant rates, overflow. And a parameter
// that drifts: the inflow.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/effects/constant_rate.hpp"
#include "surefoot/diagnose/effects/leak.hpp"
#include "surefoot/diagnose/effects/overflow.hpp"
#include "surefoot/diagnose/effects/parameter_drift.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"

namespace surefoot {
namespace {

struct Tanks {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<2>;

  SimulatorInfo info() const {
    return {.name = "tanks",
            .states = {{"upper", "cm"}, {"lower", "cm"}},
            .inputs = {{"pump", "V"}},
            .outputs = {{"upper_cm", "cm"}, {"lower_cm", "cm"}},
            .parameters = {{"inflow", "cm/(s V)", 1, 0.1, 10}}};
  }
  State derivative(const State&, const Input& u, const Eigen::VectorXd& p) const { return {p[0] * u[0], 0}; }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return x; }
};

Eigen::Vector2d end_of(const Effect& effect, const std::string& at, const std::vector<double>& values, double pump,
                       const std::string& other = "") {
  Recording recording;
  recording.name = "test";
  recording.time = Eigen::VectorXd::LinSpaced(101, 0, 10);
  recording.inputs = Eigen::MatrixXd::Constant(1, 101, pump);
  recording.outputs = Eigen::MatrixXd::Zero(2, 101);
  recording.initial = Eigen::Vector2d(4, 1);
  recording.initial_scale = Eigen::Vector2d::Zero();
  Augmented augmented;
  augmented.effects = {{.name = effect.name, .attached_to = at, .form = effect.form, .other = other, .values = values}};
  return simulate_augmented(Tanks{}, augmented, recording).states.col(100);
}

TEST_CASE("a leak empties a tank exponentially") {
  CHECK(end_of(effects::leak(), "upper", {0.3}, 0)[0] == doctest::Approx(4 * std::exp(-3.0)).epsilon(1e-6));
}

TEST_CASE("a hole empties a tank in finite time") {
  CHECK(end_of(effects::leak_hole(), "upper", {0.2}, 0)[0] == doctest::Approx(std::pow(2 - 0.1 * 10, 2)).epsilon(1e-6));
  CHECK(std::abs(end_of(effects::leak_hole(), "upper", {2}, 0)[0]) < 0.01);
}

TEST_CASE("a leak with a power is that of a hole at 1/2, and of friction alone at 1") {
  const auto end = [](double rate, double exponent) {
    return end_of(effects::leak_power(), "upper", {rate, exponent}, 0)[0];
  };
  CHECK(end(0.2, 0.5) == doctest::Approx(std::pow(2 - 0.1 * 10, 2)).epsilon(1e-6));
  CHECK(end(0.3, 1) == doctest::Approx(4 * std::exp(-3.0)).epsilon(1e-6));
  CHECK(end(0.1, 2) == doctest::Approx(1 / (0.25 + 0.1 * 10)).epsilon(1e-6));
}

TEST_CASE("a constant rate adds up") {
  CHECK(end_of(effects::constant_rate(), "lower", {-0.05}, 0)[1] == doctest::Approx(0.5));
}

TEST_CASE("what overflows is lost, or arrives elsewhere by its share") {
  CHECK(end_of(effects::overflow(), "upper", {7}, 1) == Eigen::Vector2d(7, 1));
  const Eigen::Vector2d spilled = end_of(effects::overflow_spill(), "upper", {7, 0.6}, 1, "lower");
  CHECK(spilled[0] == 7);
  CHECK(spilled[1] == doctest::Approx(1 + 0.6 * (14 - 7)));
}

TEST_CASE("over a weir flows what comes in once the level is high enough") {
  const double edge = 5, outflow = 20;
  const Eigen::Vector2d end = end_of(effects::overflow_weir(), "upper", {edge, outflow}, 1);
  CHECK(end[0] == doctest::Approx(edge * (1 + std::pow(1 / outflow, 2.0 / 3))).epsilon(1e-6));
  CHECK(end[1] == 1);
  CHECK(end_of(effects::overflow_weir(), "upper", {20, outflow}, 1)[0] == doctest::Approx(14));
}

TEST_CASE("a parameter that drifts acts by its mean over time") {
  // The inflow is constant within each row of 0.1 s.
  CHECK(end_of(effects::parameter_drift(), "inflow", {0.02}, 1)[0] ==
        doctest::Approx(4 + 10 * (1 + 0.02 * (5 - 0.05))).epsilon(1e-9));
  EffectContext m;
  m.time = 100;
  const std::vector<double> p = {-1};
  CHECK(effects::parameter_drift().factor(m, p) > 0);
}

TEST_CASE("a parameter that drifts and settles has made 63 % of its change after its time constant") {
  const Effect settling = effects::parameter_drift_settling();
  EffectContext m;
  const std::vector<double> p = {0.5, 20};
  CHECK(settling.factor(m, p) == 1);
  m.time = 20;
  CHECK(settling.factor(m, p) == doctest::Approx(1 + 0.5 * 0.632121).epsilon(1e-6));
  m.time = 1e4;
  CHECK(settling.factor(m, p) == doctest::Approx(1.5));
  const std::vector<double> away = {-0.99, 20};
  CHECK(settling.factor(m, away) == 0.05);
}

TEST_CASE("a parameter whose drift is bent changes with the square of time as well") {
  EffectContext m;
  m.time = 3;
  const std::vector<double> p = {0.1, -0.02}, away = {0.1, -2};
  CHECK(effects::parameter_drift_bent().factor(m, p) == doctest::Approx(1 + 0.3 - 0.18));
  CHECK(effects::parameter_drift_bent().factor(m, away) == 0.05);
}

TEST_CASE("a parameter whose drift sets in midway has made half of its change then, and none in the first row") {
  const Effect drift = effects::parameter_drift_midway();
  const auto factor_at = [&](double time, const std::vector<double>& p) {
    EffectContext m;
    m.time = time;
    return drift.factor(m, p);
  };
  CHECK(factor_at(0, {0.4, 3, 0.5}) == 1);
  CHECK(factor_at(3, {0.4, 3, 0.5}) == doctest::Approx(1.2).epsilon(1e-3));
  CHECK(factor_at(30, {0.4, 3, 0.5}) == doctest::Approx(1.4));
  CHECK(factor_at(1, {0.4, 3, 0.5}) < 1.01);
  CHECK(factor_at(2, {0.4, 1e-6, 0.5}) == doctest::Approx(1 + 0.4 * std::tanh(2)));  // settles at once
  CHECK(factor_at(9, {-0.99, 3, 0.5}) == 0.05);
}

}  // namespace
}  // namespace surefoot
