// Effects on velocities, mostly on a cart that rolls freely or on a spring, simulated as a diagnosis does it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/effects/cogging.hpp"
#include "surefoot/diagnose/effects/constant_force.hpp"
#include "surefoot/diagnose/effects/coulomb_friction.hpp"
#include "surefoot/diagnose/effects/cubic_stiffness.hpp"
#include "surefoot/diagnose/effects/end_stop.hpp"
#include "surefoot/diagnose/effects/gravity_offset.hpp"
#include "surefoot/diagnose/effects/hysteresis.hpp"
#include "surefoot/diagnose/effects/load_dependent_friction.hpp"
#include "surefoot/diagnose/effects/quadratic_drag.hpp"
#include "surefoot/diagnose/effects/smooth_friction.hpp"
#include "surefoot/diagnose/effects/stribeck_friction.hpp"
#include "surefoot/diagnose/effects/supply_sag.hpp"
#include "surefoot/diagnose/effects/viscous_friction.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"

namespace surefoot {
namespace {

constexpr double mass = 2;  // [kg]

struct Cart {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;
  double spring = 0;  // [N/m]

  SimulatorInfo info() const {
    return {.name = "cart",
            .states = {{"q", "m"}, {"v", "m/s", "N"}},
            .inputs = {{"force", "N"}},
            .outputs = {{"q_m", "m"}},
            .parameters = {}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd&) const {
    return {x[1], (u[0] - spring * x[0]) / mass};
  }
  State effort(const State&, const Input&, const Eigen::VectorXd&) const { return {1, mass}; }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return Output(x[0]); }
};

Recording driven(int rows, double step, double q, double v, const std::vector<double>& force = {}) {
  Recording recording;
  recording.name = "test";
  recording.time = Eigen::VectorXd::LinSpaced(rows, 0, step * (rows - 1));
  recording.inputs = Eigen::MatrixXd::Zero(1, rows);
  for (std::size_t i = 0; i < force.size(); ++i) recording.inputs(0, static_cast<Eigen::Index>(i)) = force[i];
  recording.outputs = Eigen::MatrixXd::Zero(1, rows);
  recording.initial = Eigen::Vector2d(q, v);
  recording.initial_scale = Eigen::Vector2d::Zero();
  return recording;
}

Eigen::MatrixXd states_of(const Effect& effect, const std::vector<double>& values, const Recording& recording,
                          const Cart& cart = {}) {
  Augmented augmented;
  augmented.effects = {{.name = effect.name, .attached_to = "v", .form = effect.form, .values = values}};
  return simulate_augmented(cart, augmented, recording).states;
}

double energy(const Eigen::Vector2d& state, const Cart& cart = {}) {
  return 0.5 * mass * state[1] * state[1] + 0.5 * cart.spring * state[0] * state[0];
}

TEST_CASE("viscous friction slows a rolling cart down exponentially") {
  const auto x = states_of(effects::viscous_friction(), {3}, driven(101, 0.01, 0, 2));
  CHECK(x(1, 100) == doctest::Approx(2 * std::exp(-3 / mass)).epsilon(1e-8));
}

TEST_CASE("quadratic drag slows a rolling cart down hyperbolically") {
  const auto x = states_of(effects::quadratic_drag(), {3}, driven(101, 0.01, 0, -2));
  CHECK(x(1, 100) == doctest::Approx(-2 / (1 + 3 / mass * 2)).epsilon(1e-8));
}

TEST_CASE("dry friction stops a rolling cart at the right place, for good") {
  const auto x = states_of(effects::coulomb_friction(), {4}, driven(201, 0.007, 0, 1));
  CHECK(x(0, 200) == doctest::Approx(0.5 * mass / 4).epsilon(1e-6));
  CHECK(x(1, 200) == 0);
}

TEST_CASE("dry friction holds against forces up to its level") {
  for (const double force : {3.9, -3.9}) {
    const auto x = states_of(effects::coulomb_friction(), {4}, driven(50, 0.01, 0, 0, std::vector(50, force)));
    CHECK(x.row(0).cwiseAbs().maxCoeff() == 0);
  }
  const auto x = states_of(effects::coulomb_friction(), {4}, driven(101, 0.01, 0, 0, std::vector(101, 5.0)));
  CHECK(x(1, 100) == doctest::Approx((5 - 4) / mass).epsilon(1e-6));
}

TEST_CASE("Stribeck friction holds more at rest than in fast motion") {
  const std::vector<double> p = {4, 2, 0.1};
  const auto rest = states_of(effects::stribeck_friction(), p, driven(50, 0.01, 0, 0, std::vector(50, 5.9)));
  CHECK(rest.row(0).cwiseAbs().maxCoeff() == 0);
  const auto fast = states_of(effects::stribeck_friction(), p, driven(51, 0.01, 0, 5, std::vector(51, 5.9)));
  CHECK(fast(1, 50) == doctest::Approx(5 + 0.5 * 1.9 / mass).epsilon(1e-6));
}

TEST_CASE("Stribeck friction with a tail falls with the power of speed that it is told") {
  EffectContext m;
  m.value = -0.04;
  const std::vector<double> p = {1, 2, 0.02, 0.5}, squared = {1, 2, 0.02, 2};
  CHECK(effects::stribeck_friction_tailed().dry(m, p) == doctest::Approx(1 + 2 * std::exp(-std::sqrt(2.0))));
  CHECK(effects::stribeck_friction_tailed().dry(m, squared) ==
        doctest::Approx(effects::stribeck_friction().dry(m, squared)));
}

TEST_CASE("friction that depends on the load takes its share of the force") {
  const Effect effect = effects::load_dependent_friction();
  const auto x = states_of(effect, {0.25}, driven(101, 0.01, 0, 0, std::vector(101, 4.0)));
  CHECK(x(1, 100) == doctest::Approx(0.75 * 4 / mass).epsilon(1e-6));
  EffectContext m;
  m.drive = -3;
  m.load = 5;
  const std::vector<double> p = {0.5};
  CHECK(effect.dry(m, p) == doctest::Approx(1.5));
  CHECK(effects::load_dependent_friction_under_load().dry(m, p) == doctest::Approx(2.5));
  CHECK(effects::load_dependent_friction_in_gears().dry(m, p) == doctest::Approx(2.0));
}

// A motor whose torque comes through a coil: no input acts on its speed at once.
struct Coil {
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;
  double constant = 0.4;  // [N m/A]

  SimulatorInfo info() const {
    return {.name = "coil",
            .states = {{"w", "rad/s", "N m"}, {"current", "A"}},
            .inputs = {{"voltage", "V"}},
            .outputs = {{"w_rad_s", "rad/s"}},
            .parameters = {}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd&) const {
    return {constant * x[1] / mass, (u[0] - x[1]) / 0.05};
  }
  State effort(const State&, const Input&, const Eigen::VectorXd&) const { return {mass, 1}; }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return x.head<1>(); }
};

TEST_CASE("the drive that a friction takes its share of may come through a state of the actuator") {
  const Recording recording = driven(101, 0.01, 0, 0, std::vector(101, 4.0));
  Augmented augmented;
  augmented.effects = {{.name = "load_dependent_friction", .attached_to = "w", .form = "drive", .values = {0.25}}};
  const auto rubbed = simulate_augmented(Coil{}, augmented, recording).states;
  const auto weaker = simulate_augmented(Coil{.constant = 0.75 * 0.4}, Augmented{}, recording).states;
  CHECK(rubbed(0, 100) > 0.1);
  CHECK(rubbed(0, 100) == doctest::Approx(weaker(0, 100)).epsilon(2e-3));  // it sets out within the first row
}

TEST_CASE("a friction with presliding has all of its level after some travel, and none where it reversed") {
  const Effect effect = effects::with_presliding(effects::load_dependent_friction());
  CHECK(effect.form == "drive, presliding");
  CHECK_NOTHROW(check(effect));
  const std::vector<double> p = {0.25, 0.01};
  EffectContext m;
  m.drive = 4;
  std::vector<double> hidden(2);
  effect.start(m, p, hidden);
  CHECK(effect.force(m, p, hidden) == 0);
  m.position = 0.01;
  CHECK(effect.force(m, p, hidden) == doctest::Approx(-(1 - std::exp(-1.0))));
  m.position = 0.2;
  CHECK(effect.force(m, p, hidden) == doctest::Approx(-1));
  effect.advance(m, p, hidden);
  m.position = 0.1;
  CHECK(effect.force(m, p, hidden) == doctest::Approx(1).epsilon(1e-3));
}

TEST_CASE("damped bristles add to a friction while they bend, and nothing once it slides") {
  const Effect effect = effects::coulomb_friction_damped();
  CHECK(effect.form == "presliding, damped");
  CHECK(effect.extends == std::vector<std::string>{"", "smooth", "presliding"});
  CHECK_NOTHROW(check(effect));
  const std::vector<double> p = {3, 0.01, 0.02};
  EffectContext m;
  std::vector<double> hidden(2);
  effect.start(m, p, hidden);
  m.value = 0.1;
  CHECK(effect.force(m, p, hidden) == doctest::Approx(-3 * 0.02 * 0.1 / 0.01));  // straight bristles
  m.position = 0.2;
  CHECK(effect.force(m, p, hidden) == doctest::Approx(-3));
  effect.advance(m, p, hidden);
  m.value = -0.1;  // a reversal bends them twice as fast
  CHECK(effect.force(m, p, hidden) == doctest::Approx(-3 * (1 - 2 * 0.02 * 0.1 / 0.01)));
}

TEST_CASE("a smooth friction has three quarters of its level at its onset, and all of it above") {
  const Effect effect = effects::smoothed(effects::coulomb_friction());
  CHECK(effect.form == "smooth");
  CHECK_FALSE(effect.dry);  // it holds nothing
  CHECK_NOTHROW(check(effect));
  const std::vector<double> p = {2, 0.1};
  EffectContext m;
  CHECK(effect.force(m, p, {}) == 0);
  m.value = 0.1;
  CHECK(effect.force(m, p, {}) == doctest::Approx(-2 * std::tanh(1.0)));
  m.value = -1;
  CHECK(effect.force(m, p, {}) == doctest::Approx(2));
  CHECK(effects::smoothed(effects::load_dependent_friction()).form == "drive, smooth");
}

TEST_CASE("a friction that creeps does in whole rows what a smooth one with so small an onset does in tiny steps") {
  const Effect creeping = effects::creeping(effects::coulomb_friction());
  CHECK(creeping.form == "creeping");
  CHECK(creeping.extends == std::vector<std::string>{""});
  CHECK(effects::creeping(effects::stribeck_friction_tailed()).extends ==
        std::vector<std::string>{"tailed", "creeping"});
  CHECK_NOTHROW(check(creeping));
  constexpr int fine = 100;  // steps in a row of 10 ms: what lasts 0.5 ms is smooth for these
  constexpr int rows = 300;
  constexpr double level = 4, onset = 0.001;
  std::vector<double> force(rows), in_fine_steps(std::size_t{rows} * fine);
  for (std::size_t i = 0; i < rows; ++i) force[i] = i < 100 ? 3.6 : i < 200 ? -5.0 : 2.0;
  for (std::size_t i = 0; i < in_fine_steps.size(); ++i) in_fine_steps[i] = force[i / fine];
  const auto x = states_of(creeping, {level, onset}, driven(rows, 0.01, 0, 0, force));
  const auto smooth = states_of(effects::smoothed(effects::coulomb_friction()), {level, onset},
                                driven(rows * fine, 0.01 / fine, 0, 0, in_fine_steps));
  const auto plain = states_of(effects::coulomb_friction(), {level}, driven(rows, 0.01, 0, 0, force));
  CHECK(x(0, 99) == doctest::Approx(0.99 * onset * std::atanh(3.6 / level)).epsilon(1e-6));
  CHECK(x(1, 99) == 0);
  for (int row = 0; row < rows; ++row) {
    CHECK(x(0, row) == doctest::Approx(smooth(0, row * fine)).epsilon(0.01));
  }
  CHECK(std::abs(x(0, 99) - plain(0, 99)) > 100 * std::abs(x(0, 99) - smooth(0, 99 * fine)));
}

TEST_CASE("a supply gives way with the current that is drawn, and never turns round") {
  const Effect effect = effects::supply_sag_current();
  EffectContext m;
  m.drive = 12;
  m.value = 2;
  CHECK(effect.force(m, std::vector<double>{0.1}, {}) == doctest::Approx(-2.4));
  m.drive = -12;
  CHECK(effect.force(m, std::vector<double>{0.1}, {}) == doctest::Approx(2.4));
  m.value = -50;
  CHECK(effect.force(m, std::vector<double>{0.1}, {}) == doctest::Approx(12));
}

TEST_CASE("friction never adds energy") {
  const Cart cart{.spring = 30};
  for (const Effect& effect :
       {effects::viscous_friction(), effects::coulomb_friction(), effects::stribeck_friction(),
        effects::quadratic_drag(), effects::load_dependent_friction(), effects::load_dependent_friction_under_load(),
        effects::load_dependent_friction_in_gears()}) {
    CAPTURE(effect.name);
    CAPTURE(effect.form);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Rng rng(seed);
      std::vector<double> p;
      for (const EffectParameter& parameter : effect.parameters) {
        p.push_back(parameter.low + rng.uniform() * (parameter.high - parameter.low));
      }
      const auto x = states_of(effect, p, driven(300, 0.005, 0.5, 2 * rng.uniform() - 1), cart);
      for (Eigen::Index i = 1; i < x.cols(); ++i) {
        CHECK(energy(x.col(i), cart) <= energy(x.col(i - 1), cart) * (1 + 1e-5) + 1e-9);
      }
    }
  }
}

TEST_CASE("a constant force accelerates evenly") {
  const auto x = states_of(effects::constant_force(), {-3}, driven(101, 0.01, 0, 0));
  CHECK(x(0, 100) == doctest::Approx(-0.5 * 3 / mass).epsilon(1e-9));
}

TEST_CASE("a spring off center is softest there, and at 0 the plain one") {
  const Effect effect = effects::cubic_stiffness_off_center();
  EffectContext context;
  const auto force = [&](double position, double center) {
    context.position = position;
    return effect.force(context, std::vector{50.0, center}, {});
  };
  CHECK(force(0.3, 0) == doctest::Approx(-50 * 0.027));
  CHECK(force(0.1, 0.1) == 0);
  CHECK(force(0.4, 0.1) == doctest::Approx(force(0.3, 0)));
  CHECK(force(-0.2, 0.1) == doctest::Approx(-force(0.3, 0)));
}

TEST_CASE("cubic stiffness and cogging are springs without losses") {
  const Recording recording = driven(2001, 0.005, 0.3, 0.4);
  const auto cubic = states_of(effects::cubic_stiffness(), {50}, recording);
  for (const Eigen::Index i : {500, 1000, 2000}) {
    CHECK(energy(cubic.col(i)) + 12.5 * std::pow(cubic(0, i), 4) ==
          doctest::Approx(energy(cubic.col(0)) + 12.5 * std::pow(0.3, 4)).epsilon(1e-4));
  }
  const auto ripple = states_of(effects::cogging(), {0.2, 0, 0.25}, recording);
  const auto potential = [](double q) {
    return 0.2 * 0.25 / (2 * std::numbers::pi) * std::cos(8 * std::numbers::pi * q);
  };
  for (const Eigen::Index i : {500, 1000, 2000}) {
    CHECK(energy(ripple.col(i)) + potential(ripple(0, i)) ==
          doctest::Approx(energy(ripple.col(0)) + potential(0.3)).epsilon(1e-4));
  }
}

TEST_CASE("a second harmonic of cogging repeats twice as often, and is nothing at first") {
  const Effect plain = effects::cogging(), richer = effects::cogging_harmonics();
  CHECK(richer.extends == std::vector<std::string>{""});
  for (const double at : {0.0, 0.07, 0.31}) {
    const EffectContext here{.position = at};
    const std::vector<double> none{0.2, -0.1, 0.5, 0, 0}, second{0, 0, 0.5, 0.2, -0.1}, half{0.2, -0.1, 0.25};
    CHECK(richer.force(here, none, {}) == plain.force(here, std::vector<double>{0.2, -0.1, 0.5}, {}));
    CHECK(richer.force(here, second, {}) == doctest::Approx(plain.force(here, half, {})));
  }
}

TEST_CASE("cogging repeats with its period") {
  const Effect effect = effects::cogging();
  const std::vector<double> p = {0.7, -0.4, 0.3};
  EffectContext a, b;
  a.position = 0.11;
  b.position = 0.11 + 5 * 0.3;
  CHECK(effect.force(a, p, {}) == doctest::Approx(effect.force(b, p, {})));
  a.position = 0;
  CHECK(effect.force(a, p, {}) == doctest::Approx(-0.4));
}

TEST_CASE("weight off the line is largest at angle 0 and gone at a right angle") {
  EffectContext m;
  const std::vector<double> p = {2};
  CHECK(effects::gravity_offset().force(m, p, {}) == doctest::Approx(2));
  m.position = std::numbers::pi / 2;
  CHECK(std::abs(effects::gravity_offset().force(m, p, {})) < 1e-12);
}

TEST_CASE("an end stop holds the position and takes its part of the speed") {
  const auto upper = states_of(effects::end_stop_upper(), {0.5, 0.25}, driven(200, 0.01, 0, 1));
  CHECK(upper.row(0).maxCoeff() <= 0.5);
  CHECK(upper(1, 199) == doctest::Approx(-0.25));
  const auto lower = states_of(effects::end_stop_lower(), {-0.5, 0}, driven(200, 0.01, 0, -1));
  CHECK(lower.row(0).minCoeff() >= -0.5);
  CHECK(lower(1, 199) == 0);
}

TEST_CASE("an elastic end stop pushes back as far as one is in it, and never pulls") {
  const auto force = [](const Effect& stop, double position, double speed) {
    const std::vector<double> p = {stop.form[0] == 'u' ? 0.5 : -0.5, 100, 0.1};  // level, stiffness, settling
    EffectContext m;
    m.position = position;
    m.value = speed;
    return stop.force(m, p, {});
  };
  const Effect upper = effects::elastic_end_stop(true), lower = effects::elastic_end_stop(false);
  CHECK(force(upper, 0.4, 5) == 0);
  CHECK(force(upper, 0.6, 0) == doctest::Approx(-10));
  CHECK(force(upper, 0.6, 1) == doctest::Approx(-20));
  CHECK(force(upper, 0.6, -2) == 0);
  CHECK(force(lower, -0.4, -5) == 0);
  CHECK(force(lower, -0.6, -1) == doctest::Approx(20));
  CHECK(force(lower, -0.6, 2) == 0);
}

}  // namespace
}  // namespace surefoot
