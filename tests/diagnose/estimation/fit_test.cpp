// Fits: what they recover, and what they leave alone.
#include "surefoot/diagnose/estimation/fit.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/effects/leak.hpp"
#include "surefoot/diagnose/effects/quantization.hpp"
#include "surefoot/diagnose/estimation/calibrate.hpp"
#include "surefoot/diagnose/estimation/choose_integration.hpp"
#include "surefoot/diagnose/selection/candidates.hpp"
#include "tests/diagnose/estimation/noisy_tanks.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/servo_pendulum.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::LeakyTank;
using toys::ServoPendulum;

TEST_CASE("the parameters of data without noise are recovered to 1e-5, though two of them nearly trade off") {
  auto recordings = toys::servo_recordings({}, 3, 1);
  for (Recording& recording : recordings) {
    recording.outputs = simulate_augmented(ServoPendulum{}, toys::machine({1.4, 3.9, 0.014}), recording).outputs;
  }
  const BoundSimulator bound = bind_simulator(ServoPendulum{}, recordings);
  const Fit fitted = fit(bound, nominal_hypothesis(bound), problem_of(3, 0.001), serially());
  CHECK(fitted.ok);
  CHECK(fitted.loss < 1e-6);  // of residuals in units of 0.001
  CHECK(fitted.hypothesis.parameters[0] == doctest::Approx(1.4).epsilon(1e-5));
  CHECK(fitted.hypothesis.parameters[1] == doctest::Approx(3.9).epsilon(1e-5));
  CHECK(fitted.hypothesis.parameters[2] == doctest::Approx(0.014).epsilon(1e-5));
}

TEST_CASE("an effect's parameters and unknown initial states are recovered together") {
  auto recordings = tanks(3, 120, 1.7, 0.8);
  const Effect leak_in{.name = "spring",
                       .place = Place::state,
                       .parameters = {{.name = "rate", .measure = {}, .low = -2, .high = 2, .starts = {0.01}}},
                       .force = [](const EffectContext&, Values p, Values) { return p[0]; }};
  const Augmented truth = toys::machine({1.7, 0.8}, {{"spring", "level", {}, {}, {0.3}}});
  for (Recording& recording : recordings) {
    recording.initial[0] = 0.4;
    recording.outputs = simulate_augmented(LeakyTank{}, truth, recording, {leak_in}).outputs;
    recording.initial[0] = 0;
    recording.initial_scale[0] = 0.1;
  }
  const BoundSimulator bound = bind_simulator(LeakyTank{}, recordings);
  Hypothesis start = nominal_hypothesis(bound);
  start.effects.push_back(attach(bound.info, {"spring", "level", {}, {}, {0}}, {leak_in}));
  start.values.push_back(Vec<1>(0.0));
  const Fit fitted = fit(bound, start, problem_of(3, 0.01), serially());
  CHECK(fitted.hypothesis.values[0][0] == doctest::Approx(0.3).epsilon(1e-6));
  CHECK(fitted.hypothesis.parameters[0] == doctest::Approx(1.7).epsilon(1e-6));
  for (const Eigen::VectorXd& initial : fitted.hypothesis.initial)
    CHECK(initial[0] == doctest::Approx(0.4).epsilon(1e-6));
}

TEST_CASE("a fit is never worse than its start, however few its iterations and odd its start") {
  const BoundSimulator bound =
      bind_simulator(ServoPendulum{}, toys::servo_recordings(toys::machine({1.4, 3.9, 0.014}), 2, 2));
  Rng rng(2);
  for (int k = 0; k < 12; ++k) {
    Hypothesis start = nominal_hypothesis(bound);
    for (std::size_t i = 0; i < 3; ++i) {
      const ParameterInfo& info = bound.info.parameters[i];
      start.parameters[static_cast<Eigen::Index>(i)] = info.low * std::pow(info.high / info.low, rng.uniform());
    }
    FitProblem problem = problem_of(2, 0.001);
    problem.max_iterations = 0;
    const double before = fit(bound, start, problem, serially()).loss;
    problem.max_iterations = 1 + k % 3;
    const Fit fitted = fit(bound, start, problem, serially());
    CHECK(fitted.loss <= before);
    CHECK(fitted.ok == std::isfinite(before));  // some of these machines cannot be integrated in one step per row
    if (!fitted.ok) continue;
    const Parallel serial = serially();
    const FitFunctions functions(bound, fitted.hypothesis, problem, serial);
    CHECK(mean_loss(functions.residuals(functions.start()), 4) == doctest::Approx(fitted.loss).epsilon(1e-6));
  }
}

TEST_CASE("a fit ends where it does not come near what it is to reach, and only there") {
  const BoundSimulator clean = bind_simulator(ServoPendulum{}, toys::servo_recordings({}, 3, 1));
  const Hypothesis start = nominal_hypothesis(clean);
  Hypothesis truth = start;
  truth.parameters << 1.4, 3.9, 0.014;
  const auto fitted_to = [&](double unmodelled, double reach, int& jacobians) {
    BoundSimulator bound = clean;
    for (std::size_t r = 0; r < bound.recordings.size(); ++r) {
      bound.recordings[r].outputs = simulate(clean, truth, r, {}).outputs;
      for (Eigen::Index i = 0; i < bound.recordings[r].rows(); ++i) {
        bound.recordings[r].outputs(0, i) += unmodelled * std::sin(static_cast<double>(i));
      }
    }
    FitProblem problem = problem_of(3, 0.001);
    problem.tolerance = 0;
    problem.reach = reach;
    problem.stopped = [&jacobians] { return ++jacobians < 0; };
    return fit(bound, start, problem, serially());
  };
  int needed = 0, patient = 0, ended = 0;
  CHECK(fitted_to(0, 1e-6, needed).hypothesis.parameters[0] == doctest::Approx(1.4).epsilon(1e-5));
  const double left = fitted_to(0.1, 0, patient).loss;
  CHECK(fitted_to(0.1, 1e-6, ended).loss < 1.1 * left);
  CHECK(ended < patient);

  CHECK(comes_nearer(10, 7.9, 1));  // 10 / 10^0.1 is 7.94
  CHECK_FALSE(comes_nearer(10, 8, 1));
  CHECK(comes_nearer(2, 1.9, 3));  // nearer than asked already
  CHECK_FALSE(comes_nearer(2, 2, 3));
}

// A wheel that turns by itself; what is measured is where a mark on its rim is: an angle and the same angle a whole
// turn away look alike to that sensor, and not to the one of the angle.
struct MarkedWheel {
  using State = Vec<1>;   // angle [rad]
  using Input = Vec<1>;   // unused
  using Output = Vec<3>;  // angle [rad], sine and cosine of it
  SimulatorInfo info() const {
    return {.name = "wheel",
            .states = {{"angle", "rad"}},
            .inputs = {{"torque", "N m"}},
            .outputs = {{"angle", "rad"}, {"sine", ""}, {"cosine", ""}},
            .parameters = {{"speed", "rad/s", 1, 0.1, 3}}};
  }
  State derivative(const State&, const Input&, const Eigen::VectorXd& p) const { return State(p[0]); }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const {
    return {x[0], std::sin(x[0]), std::cos(x[0])};
  }
};

TEST_CASE("an initial angle that strayed a whole turn away is read off again") {
  constexpr double turn = 2 * std::numbers::pi;
  Recording recording = toys::blank_recording(MarkedWheel{}.info(), 100, 0.05);
  recording.outputs = simulate_augmented(MarkedWheel{}, toys::machine({1.5}), recording).outputs;
  recording.initial_scale[0] = 0.5;
  const BoundSimulator bound = bind_simulator(MarkedWheel{}, {recording});
  FitProblem problem = problem_of(1, 1);
  problem.weighting.sigma = Vec<3>(10, 0.01, 0.01);  // sine and cosine keep it where it is
  Hypothesis start = nominal_hypothesis(bound);
  start.parameters[0] = 1.5;
  start.initial[0][0] = turn;
  problem.max_iterations = 0;
  const Fit fitted = fit(bound, start, problem, serially());
  CHECK(fitted.hypothesis.initial[0][0] == doctest::Approx(0));
  CHECK(fitted.loss < 1e-12);
}

TEST_CASE("where an effect begins is found though none of it shows near where the fit starts") {
  Recording recording = toys::blank_recording(toys::SlidingBlock{}.info(), 100, 0.02);
  recording.inputs.setConstant(9);
  recording.inputs(0, 0) = 0;
  BoundSimulator bound = bind_simulator(toys::SlidingBlock{}, {recording});
  bound.sizes.input_high[0] = 9;
  bound.sizes.input_low[0] = 0;
  Hypothesis truth = nominal_hypothesis(bound);
  truth.effects.push_back(attach(bound.info, {"rate_limit", "push", "not settled", {}, {9}}, all_effects()));
  truth.values.push_back(Eigen::Vector2d(9, 4));  // its rate, and where it begins
  truth.effects.push_back(attach(bound.info, {"dead_zone", "push", {}, {}, {2}}, all_effects()));
  truth.values.push_back(Vec<1>(2.0));  // less than this of a beginning does nothing
  bound.recordings[0].outputs = simulate(bound, truth, 0, {}).outputs;
  Hypothesis start = truth;
  start.values[0][1] = 0;
  FitProblem problem = problem_of(1, 1);
  problem.weighting.sigma = Vec<2>(0.01, 0.01);
  problem.free = Free::initial_only;
  const Fit fitted = fit(bound, start, problem, serially());
  CHECK(fitted.hypothesis.values[0][1] == doctest::Approx(4).epsilon(1e-2));
}

TEST_CASE("recordings begin where the truth does though a sensor rounds") {
  constexpr double step = 0.05;
  auto recordings = tanks(12, 120, 1, 1);
  const NamedEffect steps{"quantization", "level_m", "sharp", {}, {step}};
  const Augmented truth = toys::machine({1, 1}, {steps});
  std::vector<double> begun;
  Rng rng(3);
  for (Recording& recording : recordings) {
    begun.push_back(recording.initial[0] = 2 * rng.normal());
    recording.outputs = simulate_augmented(LeakyTank{}, truth, recording).outputs;
    recording.initial[0] = 0;
    recording.initial_scale[0] = 1;
  }
  const BoundSimulator bound = bind_simulator(LeakyTank{}, recordings);
  Hypothesis known = nominal_hypothesis(bound);
  known.effects.push_back(attach(bound.info, steps, {effects::sharpened(effects::quantization())}));
  known.values.push_back(Vec<1>(step));
  const FitProblem problem = problem_of(12, 0.01);
  const Hypothesis found = with_estimated_initial_states(bound, known, problem.recordings, problem, serially());
  for (std::size_t r = 0; r < begun.size(); ++r) CHECK(std::abs(found.initial[r][0] - begun[r]) < step / 4);
}

TEST_CASE("parameters are found though a sensor rounds") {
  constexpr double step = 0.05;
  const NamedEffect steps{"quantization", "level_m", "sharp", {}, {step}};
  auto recordings = tanks(3, 120, 1, 1);
  for (Recording& recording : recordings) {
    recording.outputs = simulate_augmented(LeakyTank{}, toys::machine({1, 1}, {steps}), recording).outputs;
  }
  const BoundSimulator bound = bind_simulator(LeakyTank{}, recordings);
  for (const double off : {0.8, 1.2}) {
    Hypothesis known = nominal_hypothesis(bound);
    known.parameters = Vec<2>(off, 1 / off);
    known.effects.push_back(attach(bound.info, steps, {effects::sharpened(effects::quantization())}));
    known.values.push_back(Vec<1>(step));
    const Hypothesis found = fit(bound, known, problem_of(3, 0.01), serially()).hypothesis;
    CHECK(found.parameters[0] == doctest::Approx(1).epsilon(0.01));
    CHECK(found.parameters[1] == doctest::Approx(1).epsilon(0.01));
  }
}

TEST_CASE("a start that is no number gives no fit") {
  const BoundSimulator bound = bind_simulator(LeakyTank{}, tanks(2, 100, 1, 1));
  Hypothesis start = nominal_hypothesis(bound);
  start.effects = attachments(bound, {effects::leak()}, {});
  start.values.emplace_back(Eigen::VectorXd::Constant(1, std::numeric_limits<double>::quiet_NaN()));
  const Fit fitted = fit(bound, start, problem_of(2, 0.01), serially());
  CHECK_FALSE(fitted.ok);
  CHECK(fitted.loss == std::numeric_limits<double>::infinity());
}

TEST_CASE("bounds hold, and what is not free stays") {
  const BoundSimulator bound = bind_simulator(LeakyTank{}, tanks(2, 100, 7, 0.8));  // beyond the bound of 5
  const Hypothesis nominal = nominal_hypothesis(bound);
  FitProblem problem = problem_of(2, 0.01);
  CHECK(fit(bound, nominal, problem, serially()).hypothesis.parameters[0] == doctest::Approx(5));
  problem.free = Free::initial_only;
  CHECK(fit(bound, nominal, problem, serially()).hypothesis.parameters == nominal.parameters);
  BoundSimulator fixed = bound;
  fixed.info.parameters[0].fixed = true;
  problem.free = Free::everything;
  const Fit fitted = fit(fixed, nominal, problem, serially());
  CHECK(fitted.hypothesis.parameters[0] == 1);
  CHECK(fitted.hypothesis.parameters[1] != 1);

  Hypothesis leaking = nominal;
  leaking.effects = attachments(bound, {effects::leak()}, {});
  REQUIRE(leaking.effects.size() == 1);
  leaking.values.emplace_back(Eigen::VectorXd::Constant(1, 0.01));
  problem.free = Free::all_but_effects;
  const Fit around = fit(bound, leaking, problem, serially());
  CHECK(around.hypothesis.values[0][0] == 0.01);
  CHECK(around.hypothesis.parameters != nominal.parameters);
}

TEST_CASE("the coarsest integration that is good enough is chosen, and a fine one where none is") {
  const BoundSimulator bound = bind_simulator(LeakyTank{}, tanks(1, 100, 1, 1));
  const Hypothesis nominal = nominal_hypothesis(bound);
  const Integration rough = choose_integration(bound, nominal, Eigen::VectorXd::Constant(1, 0.1), {}, {0}, serially());
  CHECK(rough.order == 2);
  CHECK(rough.step == doctest::Approx(1.5 * 0.05));
  const Integration fine = choose_integration(bound, nominal, Eigen::VectorXd::Zero(1), {}, {0}, serially());
  CHECK(fine.order == 4);
  CHECK(fine.step == doctest::Approx(0.05 / 8));
}

TEST_CASE("a few wild samples hardly move a fit") {
  auto recordings = tanks(3, 200, 1.7, 0.8, 0.01);
  for (Recording& recording : recordings) {
    for (Eigen::Index i = 20; i < 200; i += 50) recording.outputs(0, i) += 3;
  }
  const BoundSimulator bound = bind_simulator(LeakyTank{}, recordings);
  const Fit fitted = fit(bound, nominal_hypothesis(bound), problem_of(3, 0.01), serially());
  CHECK(fitted.hypothesis.parameters[0] == doctest::Approx(1.7).epsilon(0.02));
  CHECK(fitted.hypothesis.parameters[1] == doctest::Approx(0.8).epsilon(0.02));
}

}  // namespace
}  // namespace surefoot::diagnosis
