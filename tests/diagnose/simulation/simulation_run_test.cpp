// Simulations against exact solutions: order of convergence, restarts, and inputs that come late.
#include "surefoot/diagnose/simulation/simulation_run.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <vector>

#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::blank_recording;
using toys::LeakyTank;
using toys::machine;
using toys::SlidingBlock;

// Error at the end of 2 s of a spring swung from 1 m at 2 rad/s, integrated in steps of that length.
double swing_error(int order, double step) {
  Recording recording = blank_recording(SlidingBlock{}.info(), 2, 2.0);
  recording.initial[0] = 1;
  const SimulatedRun run = simulate_augmented(SlidingBlock{}, machine({2, 0, 8}, {}, {order, step}), recording);
  return std::abs(run.outputs(0, 1) - std::cos(4.0));
}

TEST_CASE("halving the step divides the error by 16 with order 4 and by 4 with order 2") {
  CHECK(swing_error(4, 0.1) / swing_error(4, 0.05) == doctest::Approx(16).epsilon(0.1));
  CHECK(swing_error(2, 0.1) / swing_error(2, 0.05) == doctest::Approx(4).epsilon(0.1));
  CHECK(swing_error(4, 0.05) < 1e-4);
}

TEST_CASE("a step of 0 means one per row, and rows longer than the step are divided evenly") {
  CHECK(swing_error(4, 0) == swing_error(4, 2.0));
  CHECK(swing_error(4, 0.6) == swing_error(4, 0.5));
}

// The same block with vectors whose size is known only when it runs.
struct DynamicBlock {
  using State = Eigen::VectorXd;
  using Input = Eigen::VectorXd;
  using Output = Eigen::VectorXd;

  SimulatorInfo info() const { return SlidingBlock{}.info(); }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return SlidingBlock{}.derivative(x, Vec<1>(u[0]), p);
  }
  State effort(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return SlidingBlock{}.effort(x, Vec<1>(u[0]), p);
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};
static_assert(Simulator<DynamicBlock>);

TEST_CASE("vectors of fixed and of dynamic size give the same bits, with effects and without") {
  Recording recording = blank_recording(SlidingBlock{}.info(), 200, 0.02);
  for (Eigen::Index i = 0; i < 200; ++i) recording.inputs(0, i) = 4 * std::sin(0.1 * static_cast<double>(i));
  for (const bool rubbing : {false, true}) {
    Augmented block = machine({2, 0.3, 8});
    if (rubbing) {
      block.effects = {{.name = "coulomb_friction", .attached_to = "v", .values = {1.5}},
                       {.name = "hysteresis", .attached_to = "v", .values = {0.5, 0.1}}};
    }
    const SimulatedRun fixed = simulate_augmented(SlidingBlock{}, block, recording);
    const SimulatedRun dynamic = simulate_augmented(DynamicBlock{}, block, recording);
    CHECK(fixed.states == dynamic.states);
    CHECK(fixed.outputs == dynamic.outputs);
    CHECK(fixed.states.row(0).cwiseAbs().maxCoeff() > 0.01);
  }
}

TEST_CASE("held inputs are exact in between rows of any length") {
  Recording recording = blank_recording(SlidingBlock{}.info(), 4, 1.0);
  recording.time << 0, 0.3, 1.0, 1.1;
  recording.inputs << 4, -2, 6, 100;
  const SimulatedRun run = simulate_augmented(SlidingBlock{}, {}, recording);
  double x = 0, v = 0;
  for (Eigen::Index row = 0; row + 1 < 4; ++row) {
    const double h = recording.time[row + 1] - recording.time[row], a = recording.inputs(0, row) / 2;
    x += h * v + 0.5 * h * h * a;
    v += h * a;
    CHECK(run.outputs(0, row + 1) == doctest::Approx(x));
    CHECK(run.outputs(1, row + 1) == doctest::Approx(v));
  }
}

TEST_CASE("a restart begins from the measured state, and only where one was measured") {
  Recording recording = blank_recording(SlidingBlock{}.info(), 12, 0.1);
  recording.outputs.row(0).setLinSpaced(1.0, 2.1);
  recording.outputs.row(1).setConstant(3);
  recording.outputs(1, 10) = std::numeric_limits<double>::quiet_NaN();
  const SimulatedRun run = simulate_augmented(SlidingBlock{}, machine({}, {}, {4, 0, 5}), recording);
  for (Eigen::Index row = 0; row <= 5; ++row) CHECK(run.outputs(0, row) == 0);
  for (Eigen::Index row = 6; row <= 10; ++row) {
    CHECK(run.outputs(0, row) == doctest::Approx(1.5 + 0.3 * static_cast<double>(row - 5)));
  }
  CHECK(run.outputs(0, 11) == doctest::Approx(2.0 + 0.3));  // the speed, not measured in row 10, stays 3
}

TEST_CASE("a simulation that follows its readings comes to them, and unmeasured speeds with them") {
  Recording recording = blank_recording(SlidingBlock{}.info(), 400, 0.1);
  for (Eigen::Index row = 0; row < 400; ++row) recording.outputs(0, row) = 5 + 0.2 * static_cast<double>(row);
  recording.outputs.row(1).setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto end_of = [&](double follow) {
    Augmented plain = machine({});
    plain.integration.follow = follow;
    return simulate_augmented(SlidingBlock{}, plain, recording).outputs.col(399).eval();
  };
  CHECK(end_of(0)[0] == 0);
  CHECK(end_of(0.2)[0] == doctest::Approx(recording.outputs(0, 399)));
  CHECK(end_of(0.01)[0] < 0.98 * recording.outputs(0, 399));  // it forgets within 100 rows
  recording.outputs.row(1).setConstant(2);
  CHECK(end_of(0.2)[1] == doctest::Approx(2));
}

// A block of which both are read in other units, the place from another zero.
struct ReadInOtherUnits : SlidingBlock {
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const {
    return {100 * x[0] - 5, -3.6 * x[1]};
  }
};

TEST_CASE("the unit in which a state is read changes nothing of how a simulation begins again or follows") {
  Recording recording = blank_recording(SlidingBlock{}.info(), 60, 0.1);
  Rng rng(4);
  for (double& push : recording.inputs.reshaped()) push = rng.normal();
  for (double& reading : recording.outputs.reshaped()) reading = rng.normal();
  Recording otherwise = recording;
  otherwise.outputs.row(0) = (100 * recording.outputs.row(0).array() - 5).matrix();
  otherwise.outputs.row(1) = -3.6 * recording.outputs.row(1);
  otherwise.initial[0] = recording.initial[0] = recording.outputs(0, 0);  // read off a sensor with a fault
  const Augmented biased = machine({}, {{"sensor_bias", "x_m", {}, {}, {0.2}}}),
                  in_cm = machine({}, {{"sensor_bias", "x_m", {}, {}, {20}}});
  for (const Integration& integration : {Integration{}, Integration{.restart = 7}, Integration{.follow = 0.2}}) {
    Augmented one = biased, other = in_cm;
    one.integration = other.integration = integration;
    const SimulatedRun plain = simulate_augmented(SlidingBlock{}, one, recording),
                       same = simulate_augmented(ReadInOtherUnits{}, other, otherwise);
    CHECK((plain.states - same.states).cwiseAbs().maxCoeff() < 1e-9);
    CHECK(plain.states.cwiseAbs().maxCoeff() > 0.1);
  }
}

TEST_CASE("an input that is late by parts of a row gives the response to the shifted input") {
  Recording recording = blank_recording(SlidingBlock{}.info(), 60, 0.05);
  Rng rng(3);
  for (double& push : recording.inputs.reshaped()) push = rng.normal();
  for (const double delay : {0.0185, 0.05, 0.13}) {
    const SimulatedRun run =
        simulate_augmented(SlidingBlock{}, machine({}, {{"input_delay", "push", {}, {}, {delay}}}), recording);
    double speed = 0, place = 0, worst_speed = 0, worst_place = 0;
    constexpr int parts = 1000;  // of a row, in which the shifted input is constant to within one part
    for (Eigen::Index row = 0; row + 1 < recording.rows(); ++row) {
      for (int part = 0; part < parts; ++part) {
        const double h = 0.05 / parts, t = recording.time[row] + (part + 0.5) * h - delay;
        const auto from = std::max<Eigen::Index>(0, static_cast<Eigen::Index>(std::floor(t / 0.05)));
        const double a = recording.inputs(0, from) / 2;
        place += h * speed + 0.5 * h * h * a;
        speed += h * a;
      }
      worst_speed = std::max(worst_speed, std::abs(run.outputs(1, row + 1) - speed));
      worst_place = std::max(worst_place, std::abs(run.outputs(0, row + 1) - place));
    }
    CHECK(worst_speed < 1e-9);
    CHECK(worst_place < 0.05 * 0.05);
  }
}

TEST_CASE("the response is a smooth function of the delay, also where it crosses a whole row") {
  Recording recording = blank_recording(LeakyTank{}.info(), 40, 0.05);
  Rng rng(4);
  for (double& valve : recording.inputs.reshaped()) valve = rng.normal();
  const auto last = [&](double delay) {
    const Augmented late = machine({}, {{"input_delay", "valve", {}, {}, {delay}}});
    return simulate_augmented(LeakyTank{}, late, recording).outputs(0, 39);
  };
  for (const double delay : {0.02, 0.05, 0.08, 0.1}) {
    CHECK(std::abs(last(delay + 1e-5) - last(delay - 1e-5)) < 1e-4);  // a change of an input by 5 would give 5e-5
  }
  CHECK(std::abs(last(0.02) - last(0.03)) > 1e-4);
}

struct Exploding {
  using State = Vec<1>;
  using Input = Vec<1>;
  using Output = Vec<1>;
  SimulatorInfo info() const {
    return {
        .name = "explosion", .states = {{"x", "1"}}, .inputs = {{"u", "1"}}, .outputs = {{"x", "1"}}, .parameters = {}};
  }
  State derivative(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const {
    return State(x[0] * x[0]);
  }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};

TEST_CASE("a simulation that runs away says so") {
  Recording recording = blank_recording(Exploding{}.info(), 100, 0.1);
  recording.initial[0] = 1;  // infinite after 1 s
  CHECK_FALSE(simulate_augmented(Exploding{}, {}, recording).finite);
  recording.initial[0] = 0.05;
  CHECK(simulate_augmented(Exploding{}, {}, recording).finite);
}

}  // namespace
}  // namespace surefoot::diagnosis
