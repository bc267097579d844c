// Where effects enter a simulation: inputs, signals, steps in the plane, parameters and sensors.
#include <doctest/doctest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "surefoot/diagnose/simulate_augmented.hpp"
#include "tests/diagnose/small_simulators.hpp"
#include "tests/support/walking_robot.hpp"

namespace surefoot::diagnosis {
namespace {

using toys::blank_recording;
using toys::LeakyTank;
using toys::machine;
using toys::SlidingBlock;
using toys::tank_recording;

const Effect doubling{.name = "doubling", .place = Place::input, .signal = [](const EffectContext& m, Values, Values) {
                        return 2 * m.value;
                      }};
const Effect fifth_more{.name = "fifth_more",
                        .place = Place::input,
                        .signal = [](const EffectContext& m, Values, Values) { return m.value + 0.2; }};

TEST_CASE("an effect on a signal inside the equations is one on what the signal stands for") {
  const Recording recording = tank_recording(1, 100);
  const SimulatedRun tapped =
      simulate_augmented(LeakyTank{}, machine({}, {{"doubling", "inflow", {}, {}, {}}}), recording, {doubling});
  const SimulatedRun stronger = simulate_augmented(LeakyTank{}, machine({2, 1}), recording);
  CHECK((tapped.outputs - stronger.outputs).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(tapped.outputs.cwiseAbs().maxCoeff() > 0.1);
}

TEST_CASE("an effect on an input changes the input itself") {
  Recording recording = tank_recording(1, 100);
  const SimulatedRun changed =
      simulate_augmented(LeakyTank{}, machine({}, {{"doubling", "valve", {}, {}, {}}}), recording, {doubling});
  recording.inputs *= 2;
  const SimulatedRun really = simulate_augmented(LeakyTank{}, {}, recording);
  CHECK((changed.outputs - really.outputs).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("two effects on one signal act in the order in which they are named") {
  const Recording recording = tank_recording(2, 100);
  const auto last = [&](const char* first, const char* second) {
    return simulate_augmented(LeakyTank{}, machine({}, {{first, "inflow", {}, {}, {}}, {second, "inflow", {}, {}, {}}}),
                              recording, {doubling, fifth_more})
        .outputs(0, 99);
  };
  // Both orders differ by an inflow of 0.2, which has filled the tank by 0.2 * (1 - exp(-t)).
  CHECK(last("fifth_more", "doubling") - last("doubling", "fifth_more") ==
        doctest::Approx(0.2 * (1 - std::exp(-recording.time[99]))).epsilon(1e-5));
}

// A level of which each row loses a tenth, and gains the input.
struct RowTank {
  using State = Vec<1>;
  using Input = Vec<1>;
  using Output = Vec<1>;

  SimulatorInfo info() const {
    return {.name = "tank by rows",
            .kind = SimulatorKind::map,
            .states = {{"level", "m"}},
            .inputs = {{"inflow", "m"}},
            .outputs = {{"level_m", "m"}},
            .parameters = {{"kept", "1", 0.9, 0.1, 1}}};
  }
  State next(const State& x, const Input& u, const Eigen::VectorXd& p) const { return p[0] * x + u; }
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};
static_assert(Simulator<RowTank>);

// Falls [m] at 2 m/s^2 from rest onto a stop at 1 m, in rows of `period`, and comes back with half its speed.
Eigen::VectorXd bouncing(double period, double level = 1) {
  Recording recording =
      blank_recording(SlidingBlock{}.info(), static_cast<Eigen::Index>(std::lround(1.8 / period)) + 1, period);
  recording.inputs.setConstant(4);  // [N], on 2 kg
  const Augmented block =
      machine({2, 0, 0}, {{.name = "end_stop", .attached_to = "v", .form = "upper", .values = {level, 0.5}}});
  return simulate_augmented(SlidingBlock{}, block, recording).outputs.row(0);
}

TEST_CASE("a stop is hit at its time within a step, whatever the length of rows") {
  for (const double period : {0.3, 0.09, 0.01}) {
    const Eigen::VectorXd x = bouncing(period);
    for (Eigen::Index row = 0; row < x.size(); ++row) {
      const double t = period * static_cast<double>(row), after = t - 1;  // hit at 1 s, with 2 m/s
      CHECK(x[row] == doctest::Approx(t < 1 ? t * t : 1 - after + after * after).epsilon(1e-8));
    }
  }
}

TEST_CASE("what follows a hit is a smooth function of where the stop is") {
  double largest = 0;
  for (int k = 0; k < 100; ++k) {
    const double level = 0.9 + 1e-3 * k;
    const auto last = [](double at) { return bouncing(0.03, at)[60]; };
    largest = std::max(largest, std::abs(last(level + 1e-3) - 2 * last(level) + last(level - 1e-3)));
  }
  CHECK(largest < 1e-5);
}

TEST_CASE("what lies on a stop stays there") {
  Recording recording = blank_recording(SlidingBlock{}.info(), 50, 0.1);
  recording.initial[0] = 1;
  recording.inputs.setConstant(4);
  const Augmented block =
      machine({2, 0, 0}, {{.name = "end_stop", .attached_to = "v", .form = "upper", .values = {1, 0.0}}});
  CHECK((simulate_augmented(SlidingBlock{}, block, recording).outputs.row(0).array() == 1).all());
}

TEST_CASE("on a map an effect on a state adds to the next value, and sees the change of this row") {
  const Effect half_more{.name = "half_more",
                         .place = Place::state,
                         .force = [](const EffectContext& m, Values, Values) { return 0.5 * m.rate; }};
  Recording recording = toys::blank_recording(RowTank{}.info(), 30, 1);
  for (Eigen::Index row = 0; row < 30; ++row) recording.inputs(0, row) = row % 7 == 0 ? 1.0 : 0.1;
  const SimulatedRun run =
      simulate_augmented(RowTank{}, machine({}, {{"half_more", "level", {}, {}, {}}}), recording, {half_more});
  double level = 0;
  for (Eigen::Index row = 0; row < 30; ++row) {
    CHECK(run.outputs(0, row) == doctest::Approx(level));
    level += 1.5 * (recording.inputs(0, row) - 0.1 * level);
  }
}

TEST_CASE("effects with more hidden states than there is room for are refused") {
  const Effect forgetful{.name = "forgetful",
                         .place = Place::input,
                         .hidden_states = 9,
                         .advance = [](const EffectContext&, Values, HiddenStates) {},
                         .signal = [](const EffectContext& m, Values, Values) { return m.value; }};
  const NamedEffect one{"forgetful", "valve", {}, {}, {}};
  CHECK_NOTHROW(simulate_augmented(LeakyTank{}, machine({}, {one, one}), tank_recording(1, 10), {forgetful}));
  CHECK_THROWS_WITH_AS(
      simulate_augmented(LeakyTank{}, machine({}, {one, one, one}), tank_recording(1, 10), {forgetful}),
      "at most 24 hidden states of effects can be simulated at once", DiagnoseError);
}

TEST_CASE("a planar effect changes each step as seen from the body") {
  const auto recordings = toys::walk_recordings([](Pose2 moved, Pose2) { return moved; }, false, 1, 5);
  const SimulatedRun run = simulate_augmented(
      toys::WalkingRobot{},
      machine({}, {{.name = "body_drift", .attached_to = "planar", .values = {0.003, -0.002, 0.01}}}), recordings[0]);
  Pose2 pose;
  double heading = 0;
  for (Eigen::Index row = 0; row + 1 < recordings[0].rows(); ++row) {
    const auto order = recordings[0].inputs.col(row);
    pose = pose * Pose2{order[0] + 0.003, order[1] - 0.002, order[2] + 0.01};
    heading += order[2] + 0.01;
    CHECK(run.outputs(0, row + 1) == doctest::Approx(pose.x).epsilon(1e-9));
    CHECK(run.outputs(1, row + 1) == doctest::Approx(pose.y).epsilon(1e-9));
    CHECK(run.outputs(2, row + 1) == doctest::Approx(heading).epsilon(1e-9));
  }
}

TEST_CASE("a parameter that drifts takes a new value in every row, from its value at the start") {
  const Effect fading{.name = "fading",
                      .place = Place::parameter,
                      .parameters = {{.name = "rate", .measure = {}, .starts = {0.1}}},
                      .factor = [](const EffectContext& m, Values p) { return 1 + p[0] * m.time; }};
  Recording recording = toys::blank_recording(SlidingBlock{}.info(), 21, 0.1);
  recording.time.array() += 7;  // times of a recording need not begin at 0
  recording.inputs.setConstant(1);
  const SimulatedRun run =
      simulate_augmented(SlidingBlock{}, machine({}, {{"fading", "mass", {}, {}, {0.5}}}), recording, {fading});
  double speed = 0;
  for (int row = 0; row < 20; ++row) {
    CHECK(run.outputs(1, row) == doctest::Approx(speed));
    speed += 0.1 / (2 * (1 + 0.5 * 0.1 * row));
  }
}

TEST_CASE("a sensor that is off changes what is read and not what moves") {
  Recording recording = tank_recording(3, 50);
  const auto biased = machine({}, {{.name = "sensor_bias", .attached_to = "level_m", .values = {0.25}}});
  recording.outputs(0, 0) = recording.initial[0] + 1;  // the start is known from elsewhere
  const SimulatedRun right = simulate_augmented(LeakyTank{}, {}, recording);
  const SimulatedRun off = simulate_augmented(LeakyTank{}, biased, recording);
  CHECK(off.states == right.states);
  CHECK((off.outputs - right.outputs).minCoeff() == doctest::Approx(0.25));
  CHECK((off.outputs - right.outputs).maxCoeff() == doctest::Approx(0.25));
  recording.outputs(0, 0) = recording.initial[0];  // the start was read off that sensor
  CHECK(simulate_augmented(LeakyTank{}, biased, recording).states(0, 0) ==
        doctest::Approx(recording.initial[0] - 0.25));
}

TEST_CASE("an initial state that a late sensor read is what it reads by its delay later") {
  Recording recording = tank_recording(3, 50);
  const auto late = machine({}, {{.name = "sensor_delay", .attached_to = "level_m", .values = {0.12}}});
  recording.initial[0] = recording.outputs(0, 0) = 1.0;
  recording.outputs(0, 2) = 1.2, recording.outputs(0, 3) = 1.5;  // 0.1 s and 0.15 s later
  CHECK(simulate_augmented(LeakyTank{}, late, recording).states(0, 0) == doctest::Approx(1.2 + 0.4 * 0.3));
  recording.outputs(0, 3) = std::numeric_limits<double>::quiet_NaN();  // not known then
  CHECK(simulate_augmented(LeakyTank{}, late, recording).states(0, 0) == 1.0);
  recording.initial[0] = 0.9;  // known from elsewhere
  CHECK(simulate_augmented(LeakyTank{}, late, recording).states(0, 0) == 0.9);
}

}  // namespace
}  // namespace surefoot::diagnosis
