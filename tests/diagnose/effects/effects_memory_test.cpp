// Effects on velocities that remember: hysteresis, backlash, an elastic joint.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/effects/backlash.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/effects/cogging.hpp"
#include "surefoot/diagnose/effects/constant_force.hpp"
#include "surefoot/diagnose/effects/cubic_stiffness.hpp"
#include "surefoot/diagnose/effects/detail/two_masses.hpp"
#include "surefoot/diagnose/effects/hysteresis.hpp"
#include "surefoot/diagnose/effects/joint_elasticity.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"

namespace surefoot {
namespace {

struct Spring {  // of frequency 6 rad/s and unit inertia, pushed by the input
  using State = Vec<2>;
  using Input = Vec<1>;
  using Output = Vec<1>;
  double stiffness = 36, damping = 0;

  SimulatorInfo info() const {
    return {.name = "spring",
            .states = {{"q", "rad"}, {"v", "rad/s", "N m"}},
            .inputs = {{"torque", "N m"}},
            .outputs = {{"q_rad", "rad"}},
            .parameters = {}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd&) const {
    return {x[1], u[0] - stiffness * x[0] - damping * x[1]};
  }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return Output(x[0]); }
};

Recording recording_of(int rows, double step, double q, double v) {
  Recording recording;
  recording.name = "test";
  recording.time = Eigen::VectorXd::LinSpaced(rows, 0, step * (rows - 1));
  recording.inputs = Eigen::MatrixXd::Zero(1, rows);
  recording.outputs = Eigen::MatrixXd::Zero(1, rows);
  recording.initial = Eigen::Vector2d(q, v);
  recording.initial_scale = Eigen::Vector2d::Zero();
  return recording;
}

SimulatedRun simulated(const Effect& effect, const std::vector<double>& values, const Recording& recording,
                       const Spring& spring = {}, int order = 4) {
  Augmented augmented;
  augmented.integration.order = order;
  augmented.effects = {{.name = effect.name, .attached_to = "v", .form = effect.form, .values = values}};
  return simulate_augmented(spring, augmented, recording);
}

double uniform(Rng& rng, double low, double high) { return low + rng.uniform() * (high - low); }

TEST_CASE("the play operator does nothing twice") {
  Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    const double driven = uniform(rng, -1, 1), driver = uniform(rng, -1, 1), width = rng.uniform();
    const double once = effects::behind_gap(driven, driver, width);
    CHECK(effects::behind_gap(once, driver, width) == once);
    CHECK(std::abs(once - driver) <= width + 1e-15);
  }
  CHECK(effects::behind_gap(0.3, 0.5, 0.3) == 0.3);
  CHECK(effects::beyond_gap(0.2, 0.3) == 0);
  CHECK(effects::beyond_gap(-0.5, 0.3) == doctest::Approx(-0.2));
}

TEST_CASE("the path of hysteresis does not depend on how it is cut into steps") {
  Rng rng(2);
  for (int i = 0; i < 200; ++i) {
    const double width = uniform(rng, 0.01, 1), z = width * uniform(rng, -1, 1);
    const double side = rng.uniform() < 0.5 ? -1 : 1, a = side * rng.uniform(), b = side * rng.uniform();
    using namespace effects;
    CHECK(bouc_wen_1(bouc_wen_1(z, a, width), b, width) == doctest::Approx(bouc_wen_1(z, a + b, width)));
    CHECK(bouc_wen_2(bouc_wen_2(z, a, width), b, width) == doctest::Approx(bouc_wen_2(z, a + b, width)));
    CHECK(std::abs(bouc_wen_2(z, a, width)) <= width * (1 + 1e-12));
    const double shape = uniform(rng, -2, 2), once = bouc_wen_asymmetric(z, a + b, width, shape);
    CHECK(bouc_wen_asymmetric(bouc_wen_asymmetric(z, a, width, shape), b, width, shape) == doctest::Approx(once));
    CHECK(bouc_wen_asymmetric(z, a, width, 0) == doctest::Approx(bouc_wen_1(z, a, width)));
  }
}

TEST_CASE("hysteresis solves its differential equation") {
  const double width = 0.2, small = 1e-6;
  for (const double z : {-0.15, -0.02, 0.0, 0.07, 0.19}) {
    for (const double side : {-1.0, 1.0}) {
      using namespace effects;
      const double slope = (bouc_wen_1(z, side * small, width) - z) / (side * small);
      CHECK(slope == doctest::Approx(1 - side * z / width).epsilon(1e-4));
      const double squared = (bouc_wen_2(z, side * small, width) - z) / (side * small);
      CHECK(squared == doctest::Approx(side * z > 0 ? 1 - z * z / (width * width) : 1).epsilon(1e-4));
      for (const double shape : {-1.0, -0.4, 0.6, 1.0, 1.5}) {
        const double bent = (bouc_wen_asymmetric(z, side * small, width, shape) - z) / (side * small);
        const double away = std::abs(z) / width;
        CHECK(bent == doctest::Approx(side * z > 0 ? 1 - (1 - shape) * away : 1 + (1 + shape) * away).epsilon(1e-4));
      }
    }
  }
}

TEST_CASE("hysteresis of any exponent holds those of exponent 1 and 2, and solves its equation between them") {
  using namespace effects;
  const double width = 0.3, small = 1e-5;
  for (const double z : {-0.25, -0.1, 0.0, 0.2}) {
    for (const double way : {-0.5, -0.04, 0.02, 0.9}) {
      CHECK(bouc_wen(z, way, width, 1, 1) == doctest::Approx(bouc_wen_1(z, way, width)).epsilon(1e-4));
      CHECK(bouc_wen(z, way, width, 0, 2) == doctest::Approx(bouc_wen_2(z, way, width)).epsilon(1e-4));
    }
    for (const double side : {-1.0, 1.0}) {
      const double slope = (bouc_wen(z, side * small, width, 0.4, 1.5) - z) / (side * small);
      const double away = std::pow(std::abs(z) / width, 1.5);
      CHECK(slope == doctest::Approx(side * z > 0 ? 1 - away : 1 + 0.4 * away).epsilon(1e-3));
    }
  }
  CHECK(std::isfinite(bouc_wen(0, 1e6, width, 0.4, 6)));
}

TEST_CASE("a hysteresis that begins under load has at most the force of its level") {
  const auto kept = [](const Effect& effect, std::vector<double> p, double z) {
    std::vector<double> hidden{z, 0};
    effect.limit_start(p, hidden);
    return hidden[0];
  };
  CHECK(kept(effects::hysteresis(), {2, 0.3}, 5) == 0.3);
  CHECK(kept(effects::hysteresis(), {2, 0.3}, -0.1) == -0.1);
  CHECK(kept(effects::coulomb_friction_presliding(), {2, 0.01}, -5) == -0.01);
  CHECK(kept(effects::hysteresis_asymmetric(), {2, 0.3, 0.5}, 5) == doctest::Approx(0.6));
  CHECK(kept(effects::hysteresis_asymmetric(), {2, 0.3, 1.4}, 5) == 3);  // stiffens: there is no level
}

TEST_CASE("hysteresis takes energy out of an oscillation, as much at any step") {
  for (const Effect& effect : {effects::hysteresis(), effects::hysteresis_squared()}) {
    std::vector<double> last;
    for (const double step : {0.01, 0.002}) {
      const auto x = simulated(effect, {2, 0.05}, recording_of(static_cast<int>(4 / step) + 1, step, 0.4, 0)).states;
      const auto end = x.cols() - 1;
      last.push_back(0.5 * x(1, end) * x(1, end) + 18 * x(0, end) * x(0, end));
    }
    CHECK(last[0] < 0.7 * 18 * 0.16);
    CHECK(last[0] == doctest::Approx(last[1]).epsilon(0.02));
  }
}

TEST_CASE("equations behind backlash do not notice motion within the play") {
  // Inside the play the spring seems to stay at its first position: the force is constant.
  const auto x = simulated(effects::backlash(), {0.2}, recording_of(21, 0.005, 0, 1)).states;
  CHECK(x(0, 20) == doctest::Approx(0.1).epsilon(1e-9));
  const auto far = simulated(effects::backlash(), {0.2}, recording_of(101, 0.005, 0, 6)).states;
  CHECK(far.row(0).maxCoeff() == doctest::Approx(1.0 + 0.2).epsilon(0.02));  // 6/6 rad and the play
}

TEST_CASE("a sensor behind backlash stays put at each reversal") {
  const std::vector<double> time = {0, 1, 2, 3, 4, 5}, p = {0.25};
  std::vector<double> readings = {0, 1, 2, 1.7, 1, 1.2};
  effects::backlash_sensor().sensor({time, readings}, p);
  CHECK(readings == std::vector<double>{0, 0.75, 1.75, 1.75, 1.25, 1.25});
}

TEST_CASE("a load on an elastic joint adds its inertia to slow motion") {
  const double ratio = 0.5;
  const auto x = simulated(effects::joint_elasticity(), {ratio, 150, 1}, recording_of(2001, 0.002, 0.3, 0)).states;
  const double frequency = 6 / std::sqrt(1 + ratio);
  double error = 0;
  for (Eigen::Index i = 0; i < 1000; ++i) {
    error = std::max(error, std::abs(x(0, i) - 0.3 * std::cos(frequency * 0.002 * static_cast<double>(i))));
  }
  CHECK(error < 0.02);
}

TEST_CASE("a free elastic joint swings at its frequency about the common centre") {
  const Effect effect = effects::joint_elasticity();
  const std::vector<double> p = {0.5, 40, 0.01};
  // Pushed once, the first inertia ends up with its share of the momentum and rings at the frequency.
  Recording recording = recording_of(2001, 0.001, 0, 0);
  recording.inputs(0, 0) = 1000;  // 1 N m s
  const auto x = simulated(effect, p, recording, {.stiffness = 0}).states;
  double mean = 0;
  int crossings = 0;
  for (Eigen::Index i = 1001; i <= 2000; ++i) {
    mean += x(1, i) / 1000;
    const double settled = 1 / 1.5;
    if ((x(1, i) - settled) * (x(1, i - 1) - settled) < 0) ++crossings;
  }
  CHECK(mean == doctest::Approx(1 / 1.5).epsilon(0.02));
  CHECK(std::abs(crossings - 2 * 40 / (2 * std::numbers::pi)) <= 1);
}

// Positions of two masses, coupled by a spring with a gap, the first (of unit inertia) on the spring of `Spring`, held
// by dry friction; integrated apart from the library, in steps of 10 us.
Eigen::VectorXd two_masses(const effects::TwoMasses& masses, double dry, int rows, double step, double q, double v) {
  const double reduced = masses.ratio / (1 + masses.ratio), h = 1e-5;
  const double stiffness = reduced * masses.frequency * masses.frequency;
  const double damping = 2 * reduced * masses.damping * masses.frequency;
  double other = q, speed = v;
  Eigen::VectorXd positions(rows);
  for (int row = 0; row < rows; ++row) {
    positions[row] = q;
    for (int i = 0; i < static_cast<int>(std::lround(step / h)); ++i) {
      const double bend = effects::beyond_gap(other - q, masses.half_width);
      double pull = bend == 0 ? 0 : stiffness * bend + damping * (speed - v);
      if (masses.half_width > 0 && pull * bend < 0) pull = 0;
      const double free = v + h * (pull - 36 * q);
      v = free > 0 ? std::max(0.0, free - h * dry) : std::min(0.0, free + h * dry);
      speed -= h * pull / masses.ratio;
      q += h * v;
      other += h * speed;
    }
  }
  return positions;
}

TEST_CASE("an elastic joint moves as two masses do, whatever the step and the order of integration") {
  for (const double frequency : {20.0, 60.0}) {
    const Eigen::VectorXd truth =
        two_masses({.ratio = 0.5, .frequency = frequency, .damping = 0.1}, 0, 101, 0.01, 0.3, 1);
    for (const int order : {2, 4}) {
      const auto x =
          simulated(effects::joint_elasticity(), {0.5, frequency, 0.1}, recording_of(101, 0.01, 0.3, 1), {}, order);
      CAPTURE(frequency);
      CAPTURE(order);
      CHECK((x.states.row(0).transpose() - truth).cwiseAbs().maxCoeff() < 0.01);
    }
  }
}

TEST_CASE("an elastic joint knows when dry friction holds it") {
  const effects::TwoMasses masses{.ratio = 2, .frequency = 25, .damping = 0.02};
  const Eigen::VectorXd truth = two_masses(masses, 2, 301, 0.005, 0.3, 1);
  Augmented augmented;
  augmented.effects = {{.name = "joint_elasticity", .attached_to = "v", .values = {2, 25, 0.02}},
                       {.name = "coulomb_friction", .attached_to = "v", .values = {2}}};
  const auto x = simulate_augmented(Spring{}, augmented, recording_of(301, 0.005, 0.3, 1)).states;
  CHECK((x.row(0).transpose() - truth).cwiseAbs().maxCoeff() < 0.02);
}

// As above, of the first mass with two others on it, each on a spring of its own, without friction.
Eigen::VectorXd three_masses(const effects::TwoModes& modes, int rows, double step, double q, double v) {
  constexpr double h = 1e-5;
  std::array<double, 2> other = {q, q}, speed = {v, v};
  Eigen::VectorXd positions(rows);
  for (int row = 0; row < rows; ++row) {
    positions[row] = q;
    for (int i = 0; i < static_cast<int>(std::lround(step / h)); ++i) {
      double force = -36 * q;
      for (std::size_t k = 0; k < other.size(); ++k) {
        const double reduced = modes.ratio[k] / (1 + modes.ratio[k]), frequency = modes.frequency[k];
        const double pull = reduced * frequency * (frequency * (other[k] - q) + 2 * modes.damping * (speed[k] - v));
        force += pull;
        speed[k] -= h * pull / modes.ratio[k];
      }
      v += h * force;
      q += h * v;
      for (std::size_t k = 0; k < other.size(); ++k) other[k] += h * speed[k];
    }
  }
  return positions;
}

TEST_CASE("a joint with two modes moves as three masses do, whatever the step and the order of integration") {
  for (const double step : {0.01, 0.002}) {
    const Eigen::VectorXd truth =
        three_masses({.ratio = {0.5, 0.3}, .frequency = {20, 45}, .damping = 0.1}, 101, step, 0.3, 1);
    for (const int order : {2, 4}) {
      const auto x = simulated(effects::joint_elasticity_two_modes(), {0.5, 20, 0.1, 0.3, 45},
                               recording_of(101, step, 0.3, 1), {}, order);
      CAPTURE(step);
      CAPTURE(order);
      CHECK((x.states.row(0).transpose() - truth).cwiseAbs().maxCoeff() < 0.01);
    }
  }
}

TEST_CASE("a second mode without inertia is none") {
  const auto both =
      simulated(effects::joint_elasticity_two_modes(), {0.5, 20, 0.1, 0, 45}, recording_of(101, 0.005, 0.3, 1));
  const auto one = simulated(effects::joint_elasticity(), {0.5, 20, 0.1}, recording_of(101, 0.005, 0.3, 1));
  CHECK((both.states - one.states).cwiseAbs().maxCoeff() < 1e-3);
}

TEST_CASE("a joint with a gap moves as two masses do") {
  const effects::TwoMasses masses{.ratio = 0.5, .frequency = 60, .damping = 0.2, .half_width = 0.05};
  const Eigen::VectorXd truth = two_masses(masses, 0, 201, 0.005, 0.3, 1);
  const auto x = simulated(effects::backlash_gap(), {0.5, 0.05, 60, 0.2}, recording_of(201, 0.005, 0.3, 1)).states;
  CHECK((x.row(0).transpose() - truth).cwiseAbs().maxCoeff() < 0.02);
}

TEST_CASE("a load behind a gap is left alone until the gap is crossed") {
  Recording recording = recording_of(1001, 0.001, 0, 0);
  recording.inputs(0, 0) = 1000;  // then free, at 1 rad/s
  const auto x = simulated(effects::backlash_gap(), {1, 0.2, 100, 0.2}, recording, {.stiffness = 0}).states;
  CHECK(x(1, 190) == doctest::Approx(1.0));
  CHECK(x(1, 260) < 0.5);  // hit the load
  for (Eigen::Index i = 0; i <= 1000; ++i) CHECK(std::abs(x(1, i)) < 1.001);
}

TEST_CASE("what a load behind a gap gives back is by the damping of the contact") {
  Recording recording = recording_of(1001, 0.001, 0, 0);
  recording.inputs(0, 0) = 1000;  // then free, at 1 rad/s, against a load of the same inertia
  const auto after_one_hit = [&](double damping) {
    return simulated(effects::backlash_gap(), {1, 0.2, 100, damping}, recording, {.stiffness = 0}).states(1, 300);
  };
  CHECK(std::abs(after_one_hit(0.02)) < 0.06);  // elastic: the load takes all
  CHECK(after_one_hit(0.6) > 0.35);             // both go on at nearly the same speed
  CHECK(after_one_hit(0.6) < 0.55);
}

TEST_CASE("a motor moves its load once it has crossed the play, and both as one then") {
  Recording recording = recording_of(1001, 0.001, 0, 0);
  recording.inputs.setConstant(1);  // a motor of half the inertia crosses the play of 0.2 in sqrt(0.2) s
  const auto x = simulated(effects::backlash_motor(), {0.2, 0.5}, recording, {.stiffness = 0}).states;
  CHECK(x(1, 440) == doctest::Approx(0));
  CHECK(x(1, 455) == doctest::Approx(0.455));  // the impulse of both, however it was handed on
  CHECK(x(1, 1000) == doctest::Approx(1));
  const double crossed = std::sqrt(0.2);  // then at half the motor's speed, with the acceleration of both
  CHECK(x(0, 1000) == doctest::Approx(crossed * (1 - crossed) + 0.5 * (1 - crossed) * (1 - crossed)).epsilon(1e-4));
}

TEST_CASE("a motor without play changes nothing") {
  Recording recording = recording_of(301, 0.005, 0.3, 1);
  for (Eigen::Index i = 0; i < 301; ++i) recording.inputs(0, i) = i % 60 < 30 ? 20.0 : -20.0;
  const auto tight = simulated(effects::backlash_motor(), {0, 0.3}, recording).states;
  const auto one = simulated(effects::constant_force(), {0}, recording).states;
  CHECK((tight - one).cwiseAbs().maxCoeff() < 1e-12);
  const auto narrow = simulated(effects::backlash_motor(), {1e-4, 0.3}, recording).states;
  CHECK((narrow.row(0) - one.row(0)).cwiseAbs().maxCoeff() < 2e-3);
}

TEST_CASE("hidden states are stable for any parameters at steps of 1 to 10 ms") {
  for (const Effect& effect :
       {effects::hysteresis(), effects::hysteresis_squared(), effects::backlash(), effects::backlash_gap(),
        effects::backlash_motor(), effects::joint_elasticity(), effects::cogging(), effects::cubic_stiffness()}) {
    CAPTURE(effect.name);
    CAPTURE(effect.form);
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      CAPTURE(seed);
      Rng rng(seed);
      std::vector<double> p;
      for (const EffectParameter& parameter : effect.parameters) {
        const double low = effect.name == "cubic_stiffness" ? 0 : parameter.low;  // a softening spring may break
        const double share = seed % 3 == 0 ? std::round(rng.uniform()) : rng.uniform();
        p.push_back(low + share * (parameter.high - low));
      }
      const double step = uniform(rng, 0.001, 0.01);
      Recording recording = recording_of(1000, step, 0.3, uniform(rng, -1, 1));
      for (Eigen::Index i = 0; i < 1000; ++i) {
        recording.inputs(0, i) = i % 100 < 50 ? 3.0 : -3.0;
      }
      // A spring that acts late, behind a play, feeds an undamped oscillation: no fault of the effect.
      const SimulatedRun trajectory =
          simulated(effect, p, recording, {.damping = effect.seen_position ? 4.0 : 0.0}, seed % 2 == 0 ? 4 : 2);
      CHECK(trajectory.finite);
      CHECK(trajectory.states.cwiseAbs().maxCoeff() < 100);
    }
  }
}

}  // namespace
}  // namespace surefoot
