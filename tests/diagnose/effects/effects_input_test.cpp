// Effects on the way of an input to the machine, on an integrator that sums it up: x' = u.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/effects/dead_zone.hpp"
#include "surefoot/diagnose/effects/first_order_lag.hpp"
#include "surefoot/diagnose/effects/from_rest.hpp"
#include "surefoot/diagnose/effects/input_asymmetry.hpp"
#include "surefoot/diagnose/effects/input_delay.hpp"
#include "surefoot/diagnose/effects/input_gain.hpp"
#include "surefoot/diagnose/effects/rate_limit.hpp"
#include "surefoot/diagnose/effects/saturation.hpp"
#include "surefoot/diagnose/effects/supply_sag.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"

namespace surefoot {
namespace {

struct Integrator {
  using State = Vec<1>;
  using Input = Vec<1>;
  using Output = Vec<1>;

  SimulatorInfo info() const {
    return {.name = "integrator",
            .states = {{"x", "m"}},
            .inputs = {{"u", "m/s"}},
            .outputs = {{"x_m", "m"}},
            .parameters = {}};
  }
  State derivative(const State&, const Input& u, const Eigen::VectorXd&) const { return u; }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return x; }
};

// A servo with an inner signal, its duty: v' = 20 duty - 5 v, duty = 4 (goal - q).
struct Servo {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;

  SimulatorInfo info() const {
    return {.name = "servo",
            .states = {{"q", "rad"}, {"v", "rad/s"}},
            .inputs = {{"goal", "rad"}},
            .outputs = {{"q_rad", "rad"}},
            .parameters = {},
            .signals = {"duty"}};
  }
  template <class Tap = NoTap>
  State derivative(const State& x, const Input& u, const Eigen::VectorXd&, Tap&& tap = {}) const {
    return {x[1], 20 * tap(0, 4 * (u[0] - x[0])) - 5 * x[1]};
  }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return Output(x[0]); }
};

struct Adder {  // x <- x + u, one step per row
  using State = Vec<1>;
  using Input = Vec<1>;
  using Output = Vec<1>;

  SimulatorInfo info() const {
    return {.name = "adder",
            .kind = SimulatorKind::map,
            .states = {{"x", "m"}},
            .inputs = {{"u", "m"}},
            .outputs = {{"x_m", "m"}},
            .parameters = {}};
  }
  State next(const State& x, const Input& u, const Eigen::VectorXd&) const { return x + u; }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return x; }
};

// Inputs that are 0 until row `from`, then 1.
Recording step_recording(int rows, double step, int from, Eigen::Index states = 1) {
  Recording recording;
  recording.name = "test";
  recording.time = Eigen::VectorXd::LinSpaced(rows, 0, step * (rows - 1));
  recording.inputs = Eigen::MatrixXd::Zero(1, rows);
  recording.inputs.rightCols(rows - from).setOnes();
  recording.outputs = Eigen::MatrixXd::Zero(1, rows);
  recording.initial = recording.initial_scale = Eigen::VectorXd::Zero(states);
  return recording;
}

template <Simulator S>
Eigen::VectorXd simulated(const S& simulator, const std::string& at, const Effect& effect,
                          const std::vector<double>& values, const Recording& recording,
                          const Integration& integration = {}) {
  Augmented augmented;
  augmented.effects = {{.name = effect.name, .attached_to = at, .form = effect.form, .values = values}};
  augmented.integration = integration;
  return simulate_augmented(simulator, augmented, recording).outputs.row(0);
}

double through(const Effect& effect, double u, std::vector<double> p) {
  EffectContext m;
  m.value = u;
  return effect.signal(m, p, {});
}

TEST_CASE("gain and asymmetry scale the input") {
  CHECK(through(effects::input_gain(), 3, {-0.2}) == doctest::Approx(2.4));
  CHECK(through(effects::input_asymmetry(), 3, {0.1}) == doctest::Approx(3.3));
  CHECK(through(effects::input_asymmetry(), -3, {0.1}) == doctest::Approx(-2.7));
}

TEST_CASE("a dead zone swallows small inputs and shortens large ones") {
  for (const double u : {-0.3, 0.0, 0.3}) CHECK(through(effects::dead_zone(), u, {0.3}) == 0);
  CHECK(through(effects::dead_zone(), 1, {0.3}) == doctest::Approx(0.7));
  CHECK(through(effects::dead_zone(), -1, {0.3}) == doctest::Approx(-0.7));
}

TEST_CASE("a dead zone with a step swallows small inputs and leaves large ones") {
  for (const double u : {-0.26, 0.0, 0.26}) CHECK(through(effects::dead_zone_step(), u, {0.3}) == 0);
  for (const double u : {-0.34, 0.34, 2.0}) CHECK(through(effects::dead_zone_step(), u, {0.3}) == u);
}

TEST_CASE("saturation limits large inputs, softly or not") {
  for (const double u : {-4.0, -0.4, 0.1, 7.0}) {
    CHECK(through(effects::saturation(), u, {0.5}) == std::clamp(u, -0.5, 0.5));
    CHECK(std::abs(through(effects::saturation_soft(), u, {0.5})) <= 0.5);
  }
  CHECK(through(effects::saturation_soft(), 0.01, {0.5}) == doctest::Approx(0.01).epsilon(1e-3));
}

TEST_CASE("a gradual saturation bends as sharply as it is told, up to clipping") {
  const auto gradual = [](double u, double sharpness) {
    return through(effects::saturation_gradual(), u, {0.5, sharpness});
  };
  CHECK(gradual(0.5, 1) == doctest::Approx(0.25));
  CHECK(gradual(-0.5, 1) == doctest::Approx(-0.25));
  CHECK(gradual(5, 8) == doctest::Approx(0.5).epsilon(1e-6));
  CHECK(gradual(0.25, 8) == doctest::Approx(0.25).epsilon(1e-3));
  CHECK(gradual(0, 0.5) == 0);
}

TEST_CASE("a supply sags most where it is loaded most, and never turns round") {
  CHECK(through(effects::supply_sag(), -2, {0.1}) == doctest::Approx(-1.6));
  CHECK(through(effects::supply_sag(), 5, {0.1}) == doctest::Approx(2.5));  // the most that it gives
  CHECK(through(effects::supply_sag(), 20, {0.1}) == doctest::Approx(2.5));
  CHECK(through(effects::supply_sag(), -20, {0.1}) == doctest::Approx(-2.5));
  CHECK(through(effects::supply_sag(), 20, {0}) == 20);
}

TEST_CASE("a delayed step comes later by exactly the delay") {
  for (const double delay : {0.0, 0.003, 0.01, 0.0371}) {
    const auto x = simulated(Integrator{}, "u", effects::input_delay(), {delay}, step_recording(101, 0.01, 20));
    CHECK(x[100] == doctest::Approx(0.8 - delay).epsilon(1e-9));
  }
  const auto x = simulated(Adder{}, "u", effects::input_delay(), {2}, step_recording(11, 1, 3));
  CHECK(x[5] == 0);
  CHECK(x[10] == doctest::Approx(5));
}

TEST_CASE("a lag answers a step exactly, however short it is against the interval of the rows") {
  for (const double lag : {0.0005, 0.002, 0.01, 0.05, 0.4}) {
    const auto x = simulated(Integrator{}, "u", effects::first_order_lag(), {lag}, step_recording(101, 0.01, 20));
    for (const Eigen::Index row : {20, 21, 25, 60, 100}) {
      const double t = 0.01 * static_cast<double>(row - 20);
      CHECK(x[row] == doctest::Approx(t - lag * (1 - std::exp(-t / lag))).epsilon(1e-7));
    }
  }
}

TEST_CASE("a lag of second order answers a step exactly, from a plain one to one that rings") {
  const auto at = [](double lag, double second, Eigen::Index row) {
    return simulated(Integrator{}, "u", effects::second_order_lag(), {lag, second}, step_recording(101, 0.01, 20))[row];
  };
  for (const double lag : {0.002, 0.05, 0.4}) {
    for (const Eigen::Index row : {20, 21, 25, 60, 100}) {
      const double t = 0.01 * static_cast<double>(row - 20), half = lag / 2;
      CHECK(at(lag, 1e-9, row) == doctest::Approx(t - lag * (1 - std::exp(-t / lag))).epsilon(1e-6));
      const double two_lags = t - lag + std::exp(-t / half) * (lag + t);
      CHECK(at(lag, 0.25, row) == doctest::Approx(two_lags).epsilon(1e-6));
      CHECK(at(lag, 0.25 + 1e-9, row) == doctest::Approx(two_lags).epsilon(1e-6));
      // at 1 the poles are (-1 +- i sqrt(3)) / (2 lag); what the input moves more than this is lag, and dies out
      const double turn = std::sqrt(3) / 2 / lag, gone = std::exp(-t / (2 * lag));
      const double rings = t - lag + gone * (lag * std::cos(turn * t) - 0.5 / turn * std::sin(turn * t));
      CHECK(at(lag, 1, row) == doctest::Approx(rings).epsilon(1e-6));
    }
  }
}

TEST_CASE("a lag starts from the first input") {
  const auto z = simulated(Integrator{}, "u", effects::second_order_lag(), {0.3, 0.4}, step_recording(101, 0.01, 0));
  CHECK(z[100] == doctest::Approx(1));
  const auto x = simulated(Integrator{}, "u", effects::first_order_lag(), {0.3}, step_recording(101, 0.01, 0));
  CHECK(x[100] == doctest::Approx(1));
  const auto y = simulated(Integrator{}, "u", effects::rate_limit(), {0.3}, step_recording(101, 0.01, 0));
  CHECK(y[100] == doctest::Approx(1));
}

TEST_CASE("on a machine that was not told anything before, memories of an input begin at zero") {
  const Recording told = step_recording(101, 0.01, 0);  // from the first row on
  for (const double size : {0.0371, 0.2}) {
    const auto late = simulated(Integrator{}, "u", effects::from_rest(effects::input_delay()), {size}, told);
    CHECK(late[100] == doctest::Approx(1 - size).epsilon(1e-9));
    const auto lagging = simulated(Integrator{}, "u", effects::from_rest(effects::first_order_lag()), {size}, told);
    CHECK(lagging[100] == doctest::Approx(1 - size * (1 - std::exp(-1 / size))).epsilon(1e-7));
    const auto twice =
        simulated(Integrator{}, "u", effects::from_rest(effects::second_order_lag()), {size, 0.25}, told);
    CHECK(twice[100] == doctest::Approx(1 - size + std::exp(-2 / size) * (size + 1)).epsilon(1e-7));
    const auto slow = simulated(Integrator{}, "u", effects::from_rest(effects::rate_limit()), {1 / size}, told);
    CHECK(slow[100] == doctest::Approx(1 - 0.5 * size).epsilon(1e-9));
  }
}

TEST_CASE("a limited rate answers a step with a ramp") {
  for (const double rate : {0.7, 2.0, 13.0, 300.0}) {
    const auto x = simulated(Integrator{}, "u", effects::rate_limit(), {rate}, step_recording(401, 0.01, 20));
    CHECK(x[400] == doctest::Approx(3.8 - 0.5 / rate).epsilon(1e-9));
    const double t = std::min(0.4, 1 / rate);
    CHECK(x[60] == doctest::Approx(0.5 * rate * t * t + 0.4 - t).epsilon(1e-9));
  }
}

TEST_CASE("a lag of a signal inside the equations agrees with finer integration") {
  const Recording recording = step_recording(201, 0.005, 10, 2);
  for (const double lag : {0.01, 0.03}) {
    const auto coarse = simulated(Servo{}, "duty", effects::first_order_lag(), {lag}, recording);
    const auto fine = simulated(Servo{}, "duty", effects::first_order_lag(), {lag}, recording, {.step = 0.0001});
    const auto other =
        simulated(Servo{}, "duty", effects::first_order_lag(), {1.05 * lag}, recording, {.step = 0.0001});
    CHECK((coarse - fine).norm() < 0.2 * (other - fine).norm());  // 1 % of the lag
  }
}

TEST_CASE("a limited rate of a signal inside the equations agrees with finer integration") {
  const Recording recording = step_recording(201, 0.005, 10, 2);
  for (const double rate : {5.0, 20.0}) {
    const auto coarse = simulated(Servo{}, "duty", effects::rate_limit(), {rate}, recording);
    const auto fine = simulated(Servo{}, "duty", effects::rate_limit(), {rate}, recording, {.step = 0.0001});
    CAPTURE(rate);
    CHECK((coarse - fine).cwiseAbs().maxCoeff() < 0.02);
  }
}

TEST_CASE("effects on an input keep it finite for any parameters") {
  for (const Effect& effect : input_effects()) {
    CAPTURE(effect.name);
    CAPTURE(effect.form);
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      Rng rng(seed);
      std::vector<double> p;
      for (const EffectParameter& parameter : effect.parameters) {
        const double share = seed % 3 == 0 ? std::round(rng.uniform()) : rng.uniform();
        p.push_back(parameter.low + share * (parameter.high - parameter.low));
      }
      Recording recording = step_recording(300, 0.001 + 0.009 * rng.uniform(), 0);
      for (double& u : recording.inputs.reshaped()) u = 2 * rng.uniform() - 1;
      CHECK(simulated(Integrator{}, "u", effect, p, recording).cwiseAbs().maxCoeff() < 13);
    }
  }
}

}  // namespace
}  // namespace surefoot
